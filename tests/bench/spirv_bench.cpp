// Speed of the SPIR-V interpreter: a lit, textured fragment shader of the mean length of recorded ones (43 instructions
// after spirv-opt), and a loop whose lanes leave it one after the other.
#include "tests/support/spirv_assembler.hpp"

#include <benchmark/benchmark.h>

namespace {

using tests::SpirvAssembler;
using traces::spirv::Op;
using traces::spirv::Std450;
using Id = SpirvAssembler::Id;

/// Texels of one value: what a filter costs is not the interpreter's.
class OneTexel : public tests::RecordedTextures {
  public:
    traces::spirv::Texels sample(const traces::spirv::TextureSample& call) override {
        return {call.place[0], call.place[1], call.place[0], call.place[1]};
    }
};

SpirvAssembler::Words lit_shader() {
    SpirvAssembler a;
    const Id real = a.real(), v2 = a.vector(real, 2), v3 = a.vector(real, 3), v4 = a.vector(real, 4),
             image = a.sampled_image(1);
    const Id light = a.uniform(v3, "light"), tint = a.uniform(v4, "tint"), shininess = a.uniform(real, "shininess");
    const Id one = a.constant(1.0F), zero = a.constant(0.0F);
    const Id normal = a.extended(Std450::normalize, v3, {a.load(a.input(v3, 0), v3)});
    const Id place = a.load(a.input(v3, 1), v3), uv = a.load(a.input(v2, 2), v2);
    const Id base = a.result(Op::image_sample_implicit_lod, v4, {a.load(a.uniform(image, "base"), image), uv});
    const Id twice = a.result(Op::vector_times_scalar, v2, {uv, a.constant(2.0F)});
    const Id detail = a.result(Op::image_sample_implicit_lod, v4, {a.load(a.uniform(image, "detail"), image), twice});
    const Id towards = a.extended(Std450::normalize, v3, {a.result(Op::f_sub, v3, {a.load(light, v3), place})});
    const Id cosine = a.extended(Std450::f_max, real, {a.result(Op::dot, real, {normal, towards}), zero});
    const Id eye = a.extended(Std450::normalize, v3, {a.result(Op::f_negate, v3, {place})});
    const Id half = a.extended(Std450::normalize, v3, {a.result(Op::f_add, v3, {towards, eye})});
    const Id shine = a.extended(Std450::f_max, real, {a.result(Op::dot, real, {normal, half}), zero});
    const Id specular = a.extended(Std450::pow, real, {shine, a.load(shininess, real)});
    const Id mixed =
        a.extended(Std450::f_mix, v4,
                   {base, detail, a.composite(v4, {a.constant(0.5F), a.constant(0.5F), a.constant(0.5F), zero})});
    const Id diffuse =
        a.result(Op::vector_times_scalar, v4, {a.result(Op::f_mul, v4, {mixed, a.load(tint, v4)}), cosine});
    const Id bright = a.result(Op::composite_construct, v4, {specular, specular, specular, zero});
    const Id sum = a.result(Op::f_add, v4, {diffuse, bright});
    const Id x = a.result(Op::composite_extract, real, {place, 0}),
             y = a.result(Op::composite_extract, real, {place, 1});
    const Id fog = a.extended(Std450::f_clamp, real,
                              {a.result(Op::f_add, real, {a.result(Op::f_mul, real, {x, x}), y}), zero, one});
    const Id rgb = a.result(Op::vector_shuffle, v3, {sum, sum, 0, 1, 2});
    const Id faded = a.result(
        Op::f_add, v3, {a.result(Op::vector_times_scalar, v3, {rgb, fog}), a.result(Op::f_mul, v3, {normal, eye})});
    a.store(a.output(v4, 0),
            a.result(Op::composite_construct, v4, {faded, a.result(Op::composite_extract, real, {base, 3})}));
    return a.module();
}

void report(benchmark::State& state, const tests::SpirvRun& run, std::uint64_t quads) {
    using Counter = benchmark::Counter;
    state.counters["fragments/s"] = Counter(4 * static_cast<double>(quads), Counter::kIsRate);
    state.counters["instructions/quad"] = Counter(run.quad.longest());
}

void spirv_lit_shader(benchmark::State& state) {
    tests::SpirvRun run(lit_shader());
    OneTexel textures;
    for (std::uint32_t i = 0; i < 3; ++i)
        for (std::uint32_t k = 0; k < run.input(i).components; ++k)
            run.quad.set(run.input(i), k, {0.1F, 0.2F, 0.3F, 0.4F});
    std::uint64_t quads = 0;
    for (auto _ : state) {
        for (int i = 0; i < 1000; ++i) run.quad.run(textures);
        benchmark::DoNotOptimize(run.real(0)[0]);
        quads += 1000;
    }
    report(state, run, quads);
}
BENCHMARK(spirv_lit_shader);

void spirv_lanes_that_part(benchmark::State& state) {
    SpirvAssembler a;
    const Id whole = a.whole(), bound = a.load(a.input(whole, 0), whole);
    const Id entry = a.id(), header = a.id(), next = a.id(), merge = a.id(), i = a.id(), sum = a.id(),
             following = a.id(), total = a.id();
    a.write(Op::branch, {entry});
    a.label(entry);
    a.write(Op::branch, {header});
    a.label(header);
    a.write(Op::phi, {whole, i, a.constant(0), entry, following, next});
    a.write(Op::phi, {whole, sum, a.constant(0), entry, total, next});
    const Id goes_on = a.result(Op::s_less_than, a.truth(), {i, bound});
    a.write(Op::loop_merge, {merge, next, 0});
    a.write(Op::branch_conditional, {goes_on, next, merge});
    a.label(next);
    a.write(Op::i_add, {whole, total, sum, a.result(Op::i_mul, whole, {i, i})});
    a.write(Op::i_add, {whole, following, i, a.constant(1)});
    a.write(Op::branch, {header});
    a.label(merge);
    a.store(a.output(whole, 0), sum);
    tests::SpirvRun run(a.module());
    run.quad.set_words(run.input(0), 0, {4, 8, 12, 16});
    std::uint64_t quads = 0;
    for (auto _ : state) {
        for (int k = 0; k < 1000; ++k) run.quad.run(run.textures);
        benchmark::DoNotOptimize(run.words(0)[0]);
        quads += 1000;
    }
    report(state, run, quads);
}
BENCHMARK(spirv_lanes_that_part);

} // namespace
