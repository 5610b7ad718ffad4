#include "traces/draco_module/draco_module.h"

#include <draco/compression/decode.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>

namespace {

int fail(const std::string& message, char* error, std::size_t size) {
    std::snprintf(error, size, "%s", message.c_str());
    return 1;
}

template <class T>
bool write(const draco::PointAttribute& attribute, const draco::Mesh& mesh, const RopsimDracoAttribute& wanted) {
    T* next = static_cast<T*>(wanted.values);
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point, next += wanted.components)
        if (!attribute.ConvertValue<T>(attribute.mapped_index(point), static_cast<std::int8_t>(wanted.components),
                                       next))
            return false;
    return true;
}

bool write_attribute(const draco::PointAttribute& attribute, const draco::Mesh& mesh,
                     const RopsimDracoAttribute& wanted) {
    switch (wanted.component_type) {
    case 5120:
        return write<std::int8_t>(attribute, mesh, wanted);
    case 5121:
        return write<std::uint8_t>(attribute, mesh, wanted);
    case 5122:
        return write<std::int16_t>(attribute, mesh, wanted);
    case 5123:
        return write<std::uint16_t>(attribute, mesh, wanted);
    case 5125:
        return write<std::uint32_t>(attribute, mesh, wanted);
    case 5126:
        return write<float>(attribute, mesh, wanted);
    default:
        return false;
    }
}

template <class T>
bool write_indices(const draco::Mesh& mesh, void* indices) {
    T* next = static_cast<T*>(indices);
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
        for (const draco::PointIndex& corner : mesh.face(face)) {
            if (corner.value() > std::numeric_limits<T>::max()) return false;
            *next++ = static_cast<T>(corner.value());
        }
    return true;
}

int decode(const std::uint8_t* bytes, std::size_t size, const RopsimDracoMesh* wanted, char* error,
           std::size_t error_size) {
    try {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(bytes), size);
        draco::Decoder decoder;
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok()) return fail(decoded.status().error_msg_string(), error, error_size);
        const draco::Mesh& mesh = *decoded.value();
        if (mesh.num_points() != wanted->points || std::size_t{mesh.num_faces()} * 3 != wanted->index_count)
            return fail("it has " + std::to_string(mesh.num_points()) + " points and " +
                            std::to_string(std::size_t{mesh.num_faces()} * 3) + " indices",
                        error, error_size);
        for (std::uint32_t i = 0; i < wanted->attribute_count; ++i) {
            const RopsimDracoAttribute& one = wanted->attributes[i];
            const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(one.id);
            if (attribute == nullptr) return fail("it has no attribute " + std::to_string(one.id), error, error_size);
            if (!write_attribute(*attribute, mesh, one))
                return fail("attribute " + std::to_string(one.id) + " cannot be converted", error, error_size);
        }
        const bool good = wanted->index_type == 5121   ? write_indices<std::uint8_t>(mesh, wanted->indices)
                          : wanted->index_type == 5123 ? write_indices<std::uint16_t>(mesh, wanted->indices)
                                                       : write_indices<std::uint32_t>(mesh, wanted->indices);
        return good ? 0 : fail("its indices are too large for their type", error, error_size);
    } catch (const std::exception& exception) {
        return fail(exception.what(), error, error_size);
    }
}

constexpr RopsimDracoModule draco_module{ROPSIM_DRACO_MODULE_VERSION, decode};

} // namespace

extern "C" __attribute__((visibility("default"))) const RopsimDracoModule* ropsim_draco_module() {
    return &draco_module;
}
