/* The C interface of ropsim_meshopt.so, which decodes what EXT_meshopt_compression holds. It is called in a child
 * process, as files are not trusted. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#define ROPSIM_MESHOPT_MODULE_VERSION 1U

#ifdef __cplusplus
extern "C" {
#endif

enum RopsimMeshoptMode { ROPSIM_MESHOPT_ATTRIBUTES, ROPSIM_MESHOPT_TRIANGLES, ROPSIM_MESHOPT_INDICES };
enum RopsimMeshoptFilter {
    ROPSIM_MESHOPT_NONE,
    ROPSIM_MESHOPT_OCTAHEDRAL,
    ROPSIM_MESHOPT_QUATERNION,
    ROPSIM_MESHOPT_EXPONENTIAL
};

typedef struct {
    uint32_t version; /* ROPSIM_MESHOPT_MODULE_VERSION of the module */

    /* Writes `count` elements of `stride` bytes. Returns 0, or 1 with one line in `error`: a stride or count that the
     * mode or the filter does not know, data that ends early or is no such data. */
    int (*decode)(const uint8_t* bytes, size_t size, enum RopsimMeshoptMode mode, enum RopsimMeshoptFilter filter,
                  size_t count, size_t stride, void* out, char* error, size_t error_size);
} RopsimMeshoptModule;

typedef const RopsimMeshoptModule* (*RopsimMeshoptModuleFunction)(void);
#define ROPSIM_MESHOPT_MODULE_FUNCTION "ropsim_meshopt_module"

#ifdef __cplusplus
}
#endif
