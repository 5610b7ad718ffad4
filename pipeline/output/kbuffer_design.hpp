// The contract of a k-buffer design: where it reads and writes, what protects that, and how it turns one k-buffer pass
// into passes of the machine. A design is one file in models/kbuffers plus one line in its list.
//
// Source of the options: specification 004, section 7 (Bavoil 2007, sections 4.3.1, 4.3.2, 6.5).
#pragma once

#include "pipeline/fragment/dispatch_guard.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/output/kbuffer.hpp"
#include "sim/described.hpp"

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace pipeline {

/// Where the program runs.
enum class UpdateSite : std::uint8_t {
    fragment_shader, ///< the shader reads the pixel as a texture and stores all entries
    blender,         ///< the ROP's programmable blender reads, modifies and writes
    passes,          ///< nowhere: one geometry pass per layer with a fixed-function depth test
};

/// When a store becomes visible to a texture read.
enum class Visibility : std::uint8_t { rop_cache, writeback, never_until_flush };
/// What drops stale k-buffer lines from the texture caches.
enum class TextureCoherence : std::uint8_t { none, invalidate_on_draw, invalidate_on_write };
enum class DispatchPolicy : std::uint8_t { any_pipe, tile_affinity };
/// What a programmable blender does with a quad whose pixel is inside its pipeline.
enum class BlendInterlock : std::uint8_t {
    stall,   ///< waits until the older result is written
    forward, ///< takes the older result from the pipeline's end
    none,    ///< reads the stale value (hazards)
};
/// How a peeling pass tells the layers it has already captured.
enum class PeelRule : std::uint8_t {
    exact, ///< by depth, then by submission order: no layer is lost or repeated
    eps,   ///< by depth + eps (specification A10)
};

/// What separates two batches of primitives on hardware that does not protect them.
struct FlushRule {
    std::uint32_t every_triangles = 0; ///< 0 = never
    bool every_draw = false;           ///< at every draw boundary
    bool drain = true;                 ///< wait until all quads in flight have stored
    bool writeback = true;             ///< make all stores observable
    bool invalidate = true;            ///< drop the texture caches' k-buffer lines
    bool active() const { return every_triangles != 0 || every_draw; }
};

struct ShaderSite {
    Visibility visibility = Visibility::writeback;
    TextureCoherence coherence = TextureCoherence::invalidate_on_draw;
    bool bypass_l1 = false;     ///< k-buffer reads do not look into the texture cache
    bool atomic_reads = false;  ///< one read returns all render targets of a pixel at one instant
    bool write_through = false; ///< a store cleans its tile at once
    FlushRule flush;
};

struct BlenderSite {
    BlendInterlock interlock = BlendInterlock::stall;
    std::uint32_t lanes = 4;       ///< scalar operations per cycle of one ROP's blender
    std::uint32_t port_bytes = 32; ///< tile cache port of one ROP, bytes per cycle
    std::uint32_t latency = 16;    ///< cycles from read to write
};

struct PassesSite {
    PeelRule rule = PeelRule::exact;
    double eps = 1e-4;
    DepthFormat depth_format = DepthFormat::d32f;
};

/// Hardware in front of the pipes, when the design has any.
struct SchedulingPlan {
    std::unique_ptr<DispatchGuard> guard;
    std::uint32_t side_buffer = 32;   ///< quads that wait for a conflict
    std::uint32_t lookups = 4;        ///< quads tested per cycle
    std::uint32_t wakes = 1;          ///< waiting quads dispatched per cycle
    std::uint32_t lookup_latency = 2; ///< cycles
    DispatchPolicy policy = DispatchPolicy::any_pipe;
    bool order_rule = true; ///< a quad also waits behind older waiting quads of its key
};

struct KBufferPlan {
    UpdateSite site = UpdateSite::fragment_shader;
    ShaderSite shader;
    BlenderSite blender;
    PassesSite passes;
    SchedulingPlan scheduling;
};

class KBufferDesign {
  public:
    virtual ~KBufferDesign() = default;

    virtual std::string_view id() const = 0;
    virtual std::string_view summary() const = 0;
    /// Why the design cannot run this program; empty when it can.
    virtual std::string refuses(const ModifyProgram& program) const = 0;
    /// A fresh plan for one machine.
    virtual KBufferPlan plan(const ModifyProgram& program, const View& view) const = 0;
    /// Effective parameters, and area proxies (bits of state, comparators, ALU lanes) for this machine's shape.
    virtual nlohmann::ordered_json parameters() const = 0;
    virtual nlohmann::ordered_json area(const ModifyProgram& program, const View& view,
                                        std::uint32_t quads_in_flight) const = 0;
};

} // namespace pipeline

template <>
struct sim::EnumNames<pipeline::Visibility> {
    static constexpr std::array<std::string_view, 3> names{"rop_cache", "writeback", "never_until_flush"};
};
template <>
struct sim::EnumNames<pipeline::TextureCoherence> {
    static constexpr std::array<std::string_view, 3> names{"none", "invalidate_on_draw", "invalidate_on_write"};
};
template <>
struct sim::EnumNames<pipeline::DispatchPolicy> {
    static constexpr std::array<std::string_view, 2> names{"any_pipe", "tile_affinity"};
};
template <>
struct sim::EnumNames<pipeline::BlendInterlock> {
    static constexpr std::array<std::string_view, 3> names{"stall", "forward", "none"};
};
template <>
struct sim::EnumNames<pipeline::PeelRule> {
    static constexpr std::array<std::string_view, 2> names{"exact", "eps"};
};
template <>
struct sim::EnumNames<pipeline::DepthFormat> {
    static constexpr std::array<std::string_view, 3> names{"d16", "d24", "d32f"};
};
