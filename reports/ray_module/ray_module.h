/* The C interface of ropsim_rays.so: the one place that links Embree. Triangles are hit from both sides. A ray through
 * an edge that two triangles share meets one of them or both (robust intersection), but for a few in a thousand of those
 * that go exactly through a corner, which Embree lets slip through. Every function but `create` and `destroy` may be
 * called by several threads at once. While Embree works, and only then, the calling thread flushes denormal floats to
 * zero. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#define ROPSIM_RAY_MODULE_VERSION 1U

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    const float* positions; /* three floats each; one more float behind the last one can be read */
    uint32_t vertices;
    const uint32_t* indices; /* three a triangle */
    uint32_t triangles;
    int masked; /* not 0: occlusion asks the mask */
} RopsimRayMesh;

typedef struct {
    float origin[3], begin;   /* points origin + distance * direction, */
    float direction[3], end; /* begin <= distance <= end */
} RopsimRay;

typedef struct {
    uint32_t mesh, triangle; /* numbers in the order of `create` */
    float distance;
    float u, v; /* shares of the triangle's second and third corner */
} RopsimRayHit;

/* Not 0 where the surface is there. Called by the threads that trace. */
typedef int (*RopsimRayMask)(void* mask_data, uint32_t mesh, uint32_t triangle, float u, float v);

typedef struct RopsimRayScene RopsimRayScene;

typedef struct {
    uint32_t version; /* ROPSIM_RAY_MODULE_VERSION of the module */

    /* The scene, or null with one line in `error`. Meshes and mask stay where they are until `destroy`. All cores build
     * it. */
    RopsimRayScene* (*create)(const RopsimRayMesh* meshes, uint32_t count, RopsimRayMask mask, void* mask_data,
                              char* error, size_t size);
    void (*destroy)(RopsimRayScene* scene);

    /* All hits of a ray, in no order; a triangle may be reported more than once, and masks are not asked. Returns how
     * many there are; at most `capacity` of them are written. */
    size_t (*hits)(const RopsimRayScene* scene, const RopsimRay* ray, RopsimRayHit* hits, size_t capacity);

    /* occluded[i] becomes 1 where ray i meets anything, else 0. `coherent` not 0: neighbours in the list go nearly the
     * same way. */
    void (*occluded)(const RopsimRayScene* scene, const RopsimRay* rays, size_t count, int coherent, uint8_t* occluded);
} RopsimRayModule;

typedef const RopsimRayModule* (*RopsimRayModuleFunction)(void);
#define ROPSIM_RAY_MODULE_FUNCTION "ropsim_ray_module"

#ifdef __cplusplus
}
#endif
