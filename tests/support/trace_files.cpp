#include "tests/support/trace_files.hpp"

#include "sim/check.hpp"
#include "tests/support/program_run.hpp"
#include "traces/camera.hpp"
#include "traces/rtrace/chunk_reader.hpp"
#include "traces/rtrace/little_endian.hpp"

#include <cstring>

namespace support {

namespace rtrace = traces::rtrace;

namespace {

template <class T>
Bytes as_buffer(const std::vector<T>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

pipeline::Texture chequered() {
    pipeline::Texture texture;
    texture.name = "Schachbrett \xE2\x99\x9E";
    texture.make_empty_levels(4, 2);
    for (std::uint32_t i = 0; i < 8; ++i)
        for (const int channel : {i % 2 == 0 ? 255 : 20, 128, 40, 255})
            texture.levels[0].rgba.push_back(static_cast<std::uint8_t>(channel));
    texture.make_mips();
    texture.wrap_u = pipeline::Wrap::border;
    texture.wrap_v = pipeline::Wrap::mirror;
    texture.border = {0.25F, 0.5F, 0.75F, 1.0F};
    return texture;
}

/// A strip of two triangles, restarted, with packed normals and a texture.
pipeline::Geometry strip() {
    pipeline::Geometry geometry;
    geometry.name = "strip";
    geometry.topology = pipeline::Topology::triangle_strip;
    geometry.vertex_count = 4;
    geometry.index_type = pipeline::IndexType::u16;
    geometry.index_buffer = 2;
    geometry.index_count = 8;
    geometry.primitive_restart = true;
    geometry.attributes = {{pipeline::Semantic::position, pipeline::ComponentType::f32, 3, false, 0, 0, 20},
                           {pipeline::Semantic::texcoord0, pipeline::ComponentType::f32, 2, false, 0, 12, 20},
                           {pipeline::Semantic::normal, pipeline::ComponentType::s10_10_10_2, 4, true, 1, 0, 4}};
    return geometry;
}

} // namespace

traces::Trace rich_trace() {
    traces::Trace trace;
    traces::Scene& scene = trace.scene;
    scene.name = "gen:rich";
    scene.hash = "0123456789abcdef";
    scene.triangles = 4;
    scene.notes = {"a note"};
    scene.resources = std::make_shared<pipeline::Resources>();
    pipeline::Resources& resources = *scene.resources;
    const std::vector<float> corners{-1, -1, 0, 0, 0, 1, -1, 0, 1, 0, -1, 1, 0, 0, 1, 1, 1, -0.0F, 1, 1};
    const std::vector<std::uint32_t> normals(4, 511U << 20U);
    const std::vector<std::uint16_t> indices{0, 1, 2, 0xFFFF, 1, 3, 2, 0xFFFF};
    resources.buffers = {{"corners", as_buffer(corners), 0},
                         {"normals", as_buffer(normals), 0},
                         {"indices", as_buffer(indices), 0},
                         {"corners again", as_buffer(corners), 0},
                         {"empty", {}, 0}};
    resources.textures = {chequered()};
    pipeline::Geometry list = strip();
    list.name = "list";
    list.topology = pipeline::Topology::triangles;
    list.index_type = pipeline::IndexType::none;
    list.index_count = 3;
    list.primitive_restart = false;
    list.attributes[0].buffer = 3;
    resources.geometries = {strip(), list};
    resources.materials.resize(2);
    resources.materials[0].name = "glass";
    resources.materials[0].alpha_mode = pipeline::AlphaMode::blend;
    resources.materials[0].base_colour = {1.0F, 0.5F, 0.25F, 0.5F};
    resources.materials[0].base_texture = 0;
    resources.materials[1].flat = true;
    glm::mat4 behind(1.0F);
    behind[3] = {0.1F, 0.2F, -1.0F, 1.0F};
    scene.draws = {{"front", 0, 0, {glm::mat4(1.0F)}}, {"many", 1, 1, {}}};
    for (int i = 0; i < 6; ++i, behind[3].z -= 0.5F) scene.draws[1].instances.push_back(behind);
    traces::Camera camera;
    camera.name = "front";
    camera.to_world[3] = {0.0F, 0.0F, 4.0F, 1.0F};
    camera.fovy = 0.7F;
    camera.near = 1.0F;
    camera.far = 20.0F;
    scene.cameras = {camera};
    traces::Light light;
    light.kind = traces::LightKind::spot;
    light.to_world[3] = {0.0F, 0.0F, 5.0F, 1.0F};
    light.inner_cone = 0.2F;
    scene.lights = {light};
    resources.find_runs();
    traces::finish_scene(scene);
    trace.metadata = {"a test", "rich", "as the project", scene.name, scene.hash};
    trace.frame.view = traces::make_view(scene, "0", 16, 12);
    trace.frame.camera = "0";
    trace.frame.workload = traces::usual_workload();
    trace.frame.options = R"({"k":3})";
    trace.frame.parameters = R"({"k":3,"opacity":0.75})";
    trace.frame.notes = {"of the camera"};
    return trace;
}

std::vector<Chunk> chunks_in(const std::filesystem::path& file) {
    rtrace::ChunkReader reader(file);
    std::vector<Chunk> chunks;
    while (const auto head = reader.next())
        if (head->type != rtrace::chunk::done) chunks.push_back({head->type, reader.content()});
    return chunks;
}

Bytes file_of(const std::vector<Chunk>& chunks) {
    Bytes file(rtrace::file_head_bytes);
    std::memcpy(file.data(), rtrace::magic.data(), rtrace::magic.size());
    rtrace::put_little(&file[8], rtrace::format_version);
    rtrace::Inventory inventory;
    const auto add = [&](const Chunk& chunk) {
        rtrace::ChunkHead head;
        head.type = chunk.type;
        head.flags = chunk.flags;
        head.content_bytes = head.stored_bytes = chunk.content.size();
        head.content = rtrace::name_of(chunk.content);
        const auto bytes = rtrace::bytes_of(head);
        file.insert(file.end(), bytes.begin(), bytes.end());
        file.insert(file.end(), chunk.content.begin(), chunk.content.end());
        inventory.add(head);
    };
    for (const Chunk& chunk : chunks) add(chunk);
    const auto content = inventory.content();
    add({rtrace::chunk::done, Bytes(content.begin(), content.end())});
    return file;
}

Bytes bytes_in(const std::filesystem::path& file) {
    const std::string text = ropsim_test::file_text(file);
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

void write_bytes(const std::filesystem::path& file, const Bytes& bytes) {
    ropsim_test::write_text(file, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

std::string refusal_of(const Bytes& bytes) {
    const ropsim_test::TemporaryFolder folder;
    write_bytes(folder.path() / "x.rtrace", bytes);
    try {
        const traces::Trace trace = traces::read_trace(folder.path() / "x.rtrace");
        if (!trace.recording) traces::frame_of(trace);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "";
}

} // namespace support
