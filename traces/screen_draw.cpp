#include "traces/screen_draw.hpp"

namespace traces {

BlankDraw add_blank_draw(pipeline::Resources& resources, const char* name) {
    pipeline::Buffer buffer;
    buffer.name = name;
    buffer.bytes.resize(36);
    pipeline::VertexAttribute position;
    position.buffer = static_cast<std::uint32_t>(resources.buffers.size());
    resources.buffers.push_back(std::move(buffer));
    BlankDraw blank;
    blank.geometry.name = name;
    blank.geometry.attributes = {position};
    blank.geometry.vertex_count = 3;
    blank.geometry.index_count = 3;
    blank.draw = {name, 0, static_cast<std::uint32_t>(resources.materials.size()), {glm::mat4(1.0F)}};
    resources.materials.push_back({});
    return blank;
}

void add_screen_draw(pipeline::Frame& frame) {
    auto resources = std::make_shared<pipeline::Resources>(*frame.resources);
    BlankDraw blank = add_blank_draw(*resources, "screen");
    blank.draw.geometry = static_cast<std::uint32_t>(resources->geometries.size());
    resources->geometries.push_back(std::move(blank.geometry));
    resources->place();
    frame.screen_draw = static_cast<std::uint32_t>(frame.draws.size());
    frame.draws.push_back(std::move(blank.draw));
    frame.resources = std::move(resources);
}

} // namespace traces
