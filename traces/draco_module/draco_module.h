/* The C interface of ropsim_draco.so: the one place that links libdraco. It is called in a child process, as files are
 * not trusted. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#define ROPSIM_DRACO_MODULE_VERSION 1U

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint32_t id;             /* the attribute's unique id in the Draco bitstream */
    uint32_t component_type; /* as glTF numbers them: 5120 to 5126 */
    uint32_t components;     /* 1 to 4 */
    void* values;            /* room for `points` elements, tightly packed */
} RopsimDracoAttribute;

typedef struct {
    uint32_t points; /* of the decoded mesh */
    const RopsimDracoAttribute* attributes;
    uint32_t attribute_count;
    uint32_t index_type;  /* 5121, 5123 or 5125 */
    uint32_t index_count; /* three a triangle */
    void* indices;        /* room for all of them */
} RopsimDracoMesh;

typedef struct {
    uint32_t version; /* ROPSIM_DRACO_MODULE_VERSION of the module */

    /* Fills the arrays of `mesh` from a Draco bitstream. Returns 0, or 1 with one line in `error`: no triangle mesh,
     * other counts than those asked for, no such attribute. */
    int (*decode)(const uint8_t* bytes, size_t size, const RopsimDracoMesh* mesh, char* error, size_t error_size);
} RopsimDracoModule;

typedef const RopsimDracoModule* (*RopsimDracoModuleFunction)(void);
#define ROPSIM_DRACO_MODULE_FUNCTION "ropsim_draco_module"

#ifdef __cplusplus
}
#endif
