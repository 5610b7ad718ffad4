/* The C interface of ropsim_glsl.so, which makes SPIR-V of GLSL with glslang and SPIRV-Tools. It is called in a child
 * process, as glslang may crash on sources that are not what it expects. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#define ROPSIM_GLSL_MODULE_VERSION 1U

#ifdef __cplusplus
extern "C" {
#endif

enum { ROPSIM_GLSL_VERTEX, ROPSIM_GLSL_FRAGMENT, ROPSIM_GLSL_STAGES };

typedef struct {
    int stage;
    const char* source;
} RopsimGlslShader;

typedef struct {
    uint32_t version; /* ROPSIM_GLSL_MODULE_VERSION of the module */

    /* Links the shaders of a program; several of a stage are one. Writes the module of each stage into `words`, the
     * vertex shader's first, and their words into `sizes`, 0 where a stage is not there. Not optimised: as glslang
     * gives it. Returns 0, or 1 with one line in `error`. */
    int (*compile)(const RopsimGlslShader* shaders, size_t count, int optimise, uint32_t* words, size_t room,
                   size_t sizes[ROPSIM_GLSL_STAGES], char* error, size_t error_size);
} RopsimGlslModule;

typedef const RopsimGlslModule* (*RopsimGlslModuleFunction)(void);
#define ROPSIM_GLSL_MODULE_FUNCTION "ropsim_glsl_module"

#ifdef __cplusplus
}
#endif
