#include "traces/meshopt_module/meshopt_module.h"

#include <meshoptimizer.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>

namespace {

int fail(const char* message, char* error, std::size_t size) {
    std::snprintf(error, size, "%s", message);
    return 1;
}

// What the specification of the extension demands; the library only asserts it.
const char* wrong_shape(RopsimMeshoptMode mode, RopsimMeshoptFilter filter, std::size_t count, std::size_t stride) {
    if (mode == ROPSIM_MESHOPT_ATTRIBUTES && (stride % 4 != 0 || stride == 0 || stride > 256))
        return "attributes need a byteStride that is a multiple of 4, at most 256";
    if (mode != ROPSIM_MESHOPT_ATTRIBUTES && stride != 2 && stride != 4) return "indices need a byteStride of 2 or 4";
    if (mode == ROPSIM_MESHOPT_TRIANGLES && count % 3 != 0) return "triangles need a count that is a multiple of 3";
    if (mode != ROPSIM_MESHOPT_ATTRIBUTES && filter != ROPSIM_MESHOPT_NONE) return "indices take no filter";
    if (filter == ROPSIM_MESHOPT_OCTAHEDRAL && stride != 4 && stride != 8)
        return "filter OCTAHEDRAL needs a byteStride of 4 or 8";
    if (filter == ROPSIM_MESHOPT_QUATERNION && stride != 8) return "filter QUATERNION needs a byteStride of 8";
    return nullptr;
}

int decode(const std::uint8_t* bytes, std::size_t size, RopsimMeshoptMode mode, RopsimMeshoptFilter filter,
           std::size_t count, std::size_t stride, void* out, char* error, std::size_t error_size) {
    if (const char* wrong = wrong_shape(mode, filter, count, stride)) return fail(wrong, error, error_size);
    const int status = mode == ROPSIM_MESHOPT_ATTRIBUTES ? meshopt_decodeVertexBuffer(out, count, stride, bytes, size)
                       : mode == ROPSIM_MESHOPT_TRIANGLES
                           ? meshopt_decodeIndexBuffer(out, count, stride, bytes, size)
                           : meshopt_decodeIndexSequence(out, count, stride, bytes, size);
    if (status != 0) return fail("its data ends early or is of another kind", error, error_size);
    if (filter == ROPSIM_MESHOPT_OCTAHEDRAL) meshopt_decodeFilterOct(out, count, stride);
    if (filter == ROPSIM_MESHOPT_QUATERNION) meshopt_decodeFilterQuat(out, count, stride);
    if (filter == ROPSIM_MESHOPT_EXPONENTIAL) meshopt_decodeFilterExp(out, count, stride);
    return 0;
}

constexpr RopsimMeshoptModule meshopt_module{ROPSIM_MESHOPT_MODULE_VERSION, decode};

} // namespace

extern "C" __attribute__((visibility("default"))) const RopsimMeshoptModule* ropsim_meshopt_module() {
    return &meshopt_module;
}
