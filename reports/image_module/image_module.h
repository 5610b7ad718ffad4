/* The C interface of ropsim_images.so: the one place that links OpenImageIO. Pixels are rows from the top, channels
 * interleaved. Every function returns 0, or 1 with one line in `error`. Files are encoded in memory and written by the
 * caller: OpenImageIO's PNG writer does not notice a full disk. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#define ROPSIM_IMAGE_MODULE_VERSION 1U

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint32_t width, height; /* pixels */
    uint32_t channels;
    const char* const* names; /* one per channel, as the file states them: "R", "layer0.Z" */
} RopsimImageShape;

/* Takes the bytes of the finished file; called once. */
typedef void (*RopsimImageSink)(void* sink_data, const uint8_t* bytes, size_t size);

typedef struct {
    uint32_t version; /* ROPSIM_IMAGE_MODULE_VERSION of the module */

    /* 8 bits a channel, the values already encoded for display (sRGB). */
    int (*encode_png)(const RopsimImageShape* shape, const uint8_t* pixels, RopsimImageSink sink, void* sink_data,
                      char* error, size_t size);

    /* 32-bit floats, scene-linear, ZIP-compressed, without the time of writing: equal pixels give equal files. */
    int (*encode_exr)(const RopsimImageShape* shape, const float* pixels, RopsimImageSink sink, void* sink_data,
                      char* error, size_t size);

    /* Any format OpenImageIO knows, converted to float. `pixels` may be null: then only the size is asked for;
     * otherwise it has room for width * height * channels values. */
    int (*read)(const char* path, uint32_t* width, uint32_t* height, uint32_t* channels, float* pixels, char* error,
                size_t size);
} RopsimImageModule;

typedef const RopsimImageModule* (*RopsimImageModuleFunction)(void);
#define ROPSIM_IMAGE_MODULE_FUNCTION "ropsim_image_module"

#ifdef __cplusplus
}
#endif
