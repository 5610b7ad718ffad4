/* The C interface of ropsim_textures.so, which decodes what tinygltf's own decoder does not, with OpenImageIO. It is
 * called in a child process, as files are not trusted. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#define ROPSIM_TEXTURE_MODULE_VERSION 1U

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint32_t version; /* ROPSIM_TEXTURE_MODULE_VERSION of the module */

    /* Decodes a file of `format` ("webp") of that size to RGBA8, not premultiplied, row 0 at the top. Returns 0, or 1
     * with one line in `error`. */
    int (*decode)(const uint8_t* bytes, size_t size, const char* format, uint32_t width, uint32_t height, uint8_t* rgba,
                  char* error, size_t error_size);
} RopsimTextureModule;

typedef const RopsimTextureModule* (*RopsimTextureModuleFunction)(void);
#define ROPSIM_TEXTURE_MODULE_FUNCTION "ropsim_texture_module"

#ifdef __cplusplus
}
#endif
