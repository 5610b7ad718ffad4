// Control flow: lanes that part and meet again, loops, switches, calls, discard, the budget.
#include "tests/support/spirv_assembler.hpp"

#include "sim/check.hpp"

#include <gtest/gtest.h>
#include <string>

namespace spirv_control_test {

namespace {

using tests::SpirvAssembler;
using tests::SpirvRun;
using traces::spirv::LaneWords;
using traces::spirv::Op;
using traces::spirv::Storage;
using Id = SpirvAssembler::Id;

/// if (condition) then else otherwise, after which `merge` goes on.
template <class Then, class Else>
void branch(SpirvAssembler& a, Id condition, Then then, Else otherwise) {
    const Id yes = a.id(), no = a.id(), merge = a.id();
    a.write(Op::selection_merge, {merge, 0});
    a.write(Op::branch_conditional, {condition, yes, no});
    a.label(yes);
    then(merge);
    a.label(no);
    otherwise(merge);
    a.label(merge);
}

/// for (i = 0; i < bound; ++i) body(i), with i in a phi.
template <class Body>
void loop(SpirvAssembler& a, Id bound, Body body) {
    const Id entry = a.id(), header = a.id(), test = a.id(), inside = a.id(), next = a.id(), merge = a.id();
    const Id whole = a.whole(), i = a.id(), following = a.id();
    a.write(Op::branch, {entry});
    a.label(entry);
    a.write(Op::branch, {header});
    a.label(header);
    a.write(Op::phi, {whole, i, a.constant(0), entry, following, next});
    a.write(Op::loop_merge, {merge, next, 0});
    a.write(Op::branch, {test});
    a.label(test);
    const Id goes_on = a.result(Op::s_less_than, a.truth(), {i, bound});
    a.write(Op::branch_conditional, {goes_on, inside, merge});
    a.label(inside);
    body(i, next, merge);
    a.label(next);
    a.write(Op::i_add, {whole, following, i, a.constant(1)});
    a.write(Op::branch, {header});
    a.label(merge);
}

std::string error_of(const SpirvAssembler::Words& words) {
    try {
        SpirvRun run(words);
        run.run();
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST(SpirvControl, LanesPartAndMeetInAPhi) {
    SpirvAssembler a;
    const Id real = a.real(), x = a.load(a.input(real, 0), real);
    Id from_yes = 0, from_no = 0, yes_block = 0, no_block = 0;
    branch(
        a, a.result(Op::f_ord_greater_than, a.truth(), {x, a.constant(0.0F)}),
        [&](Id merge) {
            yes_block = a.id();
            a.write(Op::branch, {yes_block});
            a.label(yes_block);
            from_yes = a.result(Op::f_mul, real, {x, a.constant(10.0F)});
            a.write(Op::branch, {merge});
        },
        [&](Id merge) {
            no_block = a.id();
            a.write(Op::branch, {no_block});
            a.label(no_block);
            from_no = a.result(Op::f_negate, real, {x});
            a.write(Op::branch, {merge});
        });
    const Id joined = a.result(Op::phi, real, {from_yes, yes_block, from_no, no_block});
    a.store(a.output(real, 0), joined);
    a.store(a.output(real, 1), a.result(Op::dpdx, real, {joined})); // all lanes are together again
    SpirvRun run(a.module());
    run.quad.set(run.input(0), 0, {1, -2, 3, -4});
    run.run();
    EXPECT_EQ(run.real(0), (pipeline::Lanes{10, 2, 30, 4}));
    EXPECT_EQ(run.real(1), (pipeline::Lanes{-8, -8, -26, -26}));
}

TEST(SpirvControl, LoopsOfDifferentLengthKeepWhatLanesLeftWith) {
    SpirvAssembler a;
    const Id whole = a.whole(), bound = a.load(a.input(whole, 0), whole), sum = a.local(whole, a.constant(0));
    Id square = 0;
    const Id last = a.local(whole, a.constant(-1));
    loop(a, bound, [&](Id i, Id next, Id) {
        square = a.result(Op::i_mul, whole, {i, i});
        a.store(sum, a.result(Op::i_add, whole, {a.load(sum, whole), square}));
        a.store(last, square);
        a.write(Op::branch, {next});
    });
    a.store(a.output(whole, 0), a.load(sum, whole));
    a.store(a.output(whole, 1), a.load(last, whole));
    SpirvRun run(a.module());
    run.quad.set_words(run.input(0), 0, {0, 3, 5, 1});
    run.run();
    EXPECT_EQ(run.words(0), (LaneWords{0, 5, 30, 0}));
    EXPECT_EQ(run.words(1), (LaneWords{0xFFFFFFFF, 4, 16, 0}));
    const LaneWords counts = run.quad.instructions();
    EXPECT_EQ(counts[2] - counts[1], 2 * (counts[1] - counts[3]) / 2); // per round the same number
    EXPECT_EQ(counts[1] - counts[3], 2 * (counts[3] - counts[0]));
    EXPECT_EQ(run.quad.longest(), counts[2]);
    EXPECT_EQ(run.quad.longest(0b1001), counts[3]);
}

TEST(SpirvControl, LanesThatBreakAndContinue) {
    // Adds i unless i == 1 (continue); leaves at i == the lane's number (break).
    SpirvAssembler a;
    const Id whole = a.whole(), truth = a.truth(), stop = a.load(a.input(whole, 0), whole),
             sum = a.local(whole, a.constant(0));
    loop(a, a.constant(6), [&](Id i, Id next, Id merge) {
        const Id go_on = a.id(), skip = a.id(), add = a.id();
        a.write(Op::selection_merge, {go_on, 0});
        a.write(Op::branch_conditional, {a.result(Op::i_equal, truth, {i, stop}), merge, go_on});
        a.label(go_on);
        a.write(Op::selection_merge, {add, 0});
        a.write(Op::branch_conditional, {a.result(Op::i_equal, truth, {i, a.constant(1)}), skip, add});
        a.label(skip);
        a.write(Op::branch, {next});
        a.label(add);
        a.store(sum, a.result(Op::i_add, whole, {a.load(sum, whole), i}));
        a.write(Op::branch, {next});
    });
    a.store(a.output(whole, 0), a.load(sum, whole));
    SpirvRun run(a.module());
    run.quad.set_words(run.input(0), 0, {0, 3, 99, 2});
    run.run();
    EXPECT_EQ(run.words(0), (LaneWords{0, 2, 14, 0}));
}

TEST(SpirvControl, PhisOfABlockChangeAtOnce) {
    // (x, y) = (y, x + y): Fibonacci's numbers need the old values of both.
    SpirvAssembler a;
    const Id whole = a.whole(), bound = a.load(a.input(whole, 0), whole);
    const Id entry = a.id(), header = a.id(), inside = a.id(), next = a.id(), merge = a.id();
    const Id i = a.id(), x = a.id(), y = a.id(), sum = a.id(), following = a.id();
    a.write(Op::branch, {entry});
    a.label(entry);
    a.write(Op::branch, {header});
    a.label(header);
    a.write(Op::phi, {whole, i, a.constant(0), entry, following, next});
    a.write(Op::phi, {whole, x, a.constant(0), entry, y, next});
    a.write(Op::phi, {whole, y, a.constant(1), entry, sum, next});
    const Id goes_on = a.result(Op::s_less_than, a.truth(), {i, bound});
    a.write(Op::loop_merge, {merge, next, 0});
    a.write(Op::branch_conditional, {goes_on, inside, merge});
    a.label(inside);
    a.write(Op::i_add, {whole, sum, x, y});
    a.write(Op::branch, {next});
    a.label(next);
    a.write(Op::i_add, {whole, following, i, a.constant(1)});
    a.write(Op::branch, {header});
    a.label(merge);
    a.store(a.output(whole, 0), x);
    SpirvRun run(a.module());
    run.quad.set_words(run.input(0), 0, {0, 1, 10, 7});
    run.run();
    EXPECT_EQ(run.words(0), (LaneWords{0, 1, 55, 13}));
}

TEST(SpirvControl, SwitchesFallThroughAndHaveADefault) {
    SpirvAssembler a;
    const Id whole = a.whole(), x = a.load(a.input(whole, 0), whole), result = a.local(whole, a.constant(0));
    const Id otherwise = a.id(), one = a.id(), two = a.id(), merge = a.id();
    const auto add = [&](std::int32_t n) {
        a.store(result, a.result(Op::i_add, whole, {a.load(result, whole), a.constant(n)}));
    };
    a.write(Op::selection_merge, {merge, 0});
    a.write(Op::switch_case, {x, otherwise, 1, one, 0xFFFFFFFE, two});
    a.label(otherwise);
    add(100);
    a.write(Op::branch, {merge});
    a.label(one);
    add(1);
    a.write(Op::branch, {two});
    a.label(two);
    add(20);
    a.write(Op::branch, {merge});
    a.label(merge);
    a.store(a.output(whole, 0), a.load(result, whole));
    SpirvRun run(a.module());
    run.quad.set_words(run.input(0), 0, {1, 0xFFFFFFFE, 7, 1});
    run.run();
    EXPECT_EQ(run.words(0), (LaneWords{21, 20, 100, 21}));
}

TEST(SpirvControl, CallsWithArgumentsThatAreWrittenAndAnEarlyReturn) {
    SpirvAssembler a;
    const Id real = a.real(), function = a.id(), pointer = a.pointer(Storage::function, real);
    // float f(float x, inout float y) { if (x > 0) { y = x; return 1; } y += 5; return 2; }
    const Id variable = a.local(real, a.constant(3.0F)), x = a.load(a.input(real, 0), real);
    const Id returned = a.result(Op::function_call, real, {function, x, variable});
    const Id again = a.result(Op::function_call, real, {function, a.result(Op::f_negate, real, {x}), variable});
    a.store(a.output(real, 0), returned);
    a.store(a.output(real, 1), a.load(variable, real));
    a.store(a.output(real, 2), again);
    const auto parameters = a.begin_function(function, real, {real, pointer});
    branch(
        a, a.result(Op::f_ord_greater_than, a.truth(), {parameters[0], a.constant(0.0F)}),
        [&](Id) {
            a.store(parameters[1], parameters[0]);
            a.write(Op::return_value, {a.constant(1.0F)});
        },
        [&](Id merge) { a.write(Op::branch, {merge}); });
    a.store(parameters[1], a.result(Op::f_add, real, {a.load(parameters[1], real), a.constant(5.0F)}));
    a.write(Op::return_value, {a.constant(2.0F)});
    a.end_function();
    SpirvRun run(a.module());
    run.quad.set(run.input(0), 0, {7, -8, 0, 9});
    run.run();
    EXPECT_EQ(run.real(0), (pipeline::Lanes{1, 2, 2, 1}));
    EXPECT_EQ(run.real(2), (pipeline::Lanes{2, 1, 2, 2}));
    EXPECT_EQ(run.real(1), (pipeline::Lanes{12, 8, 13, 14}));
}

TEST(SpirvControl, RecursionIsRefused) {
    SpirvAssembler a;
    const Id real = a.real(), f = a.id(), g = a.id();
    a.result(Op::function_call, real, {f, a.constant(1.0F)});
    const auto x = a.begin_function(f, real, {real});
    a.write(Op::return_value, {a.result(Op::function_call, real, {g, x[0]})});
    a.end_function();
    const auto y = a.begin_function(g, real, {real});
    a.write(Op::return_value, {a.result(Op::function_call, real, {f, y[0]})});
    a.end_function();
    EXPECT_NE(error_of(a.module()).find("(OpFunctionCall): expected no recursion"), std::string::npos)
        << error_of(a.module());
}

TEST(SpirvControl, DiscardedLanesGoOnAsHelpers) {
    SpirvAssembler a;
    const Id real = a.real(), x = a.load(a.input(real, 0), real);
    const Id yes = a.id(), merge = a.id();
    a.write(Op::selection_merge, {merge, 0});
    a.write(Op::branch_conditional, {a.result(Op::f_ord_less_than, a.truth(), {x, a.constant(0.0F)}), yes, merge});
    a.label(yes);
    a.write(Op::kill, {});
    a.label(merge);
    a.store(a.output(real, 0), a.result(Op::dpdx, real, {a.result(Op::f_mul, real, {x, a.constant(2.0F)})}));
    SpirvRun run(a.module());
    EXPECT_TRUE(run.program.discards);
    run.quad.set(run.input(0), 0, {1, -3, 5, 6});
    run.run();
    EXPECT_EQ(run.quad.alive(), 0b1101U);
    EXPECT_EQ(run.real(0)[0], -8); // the helper's product is there
    EXPECT_EQ(run.real(0)[2], 2);
    EXPECT_LT(run.quad.instructions()[1], run.quad.instructions()[0]);
    run.quad.set(run.input(0), 0, {-1, -3, -5, -6});
    run.run();
    EXPECT_EQ(run.quad.alive(), 0U);
}

TEST(SpirvControl, DemotionAndHelperInvocations) {
    SpirvAssembler a;
    constexpr std::uint32_t helper_invocation = 23;
    const Id real = a.real(), truth = a.truth(), one = a.constant(1.0F), zero = a.constant(0.0F);
    const Id helper = a.built_in(Storage::input, truth, helper_invocation);
    a.store(a.output(real, 0), a.result(Op::select, real, {a.load(helper, truth), one, zero}));
    branch(
        a, a.load(helper, truth),
        [&](Id merge) {
            a.write(Op::demote_to_helper_invocation, {});
            a.write(Op::branch, {merge});
        },
        [&](Id merge) { a.write(Op::branch, {merge}); });
    a.store(a.output(real, 1), a.result(Op::select, real, {a.result(Op::is_helper_invocation, truth, {}), one, zero}));
    SpirvRun run(a.module());
    run.run(0b0110);
    EXPECT_EQ(run.real(0), (pipeline::Lanes{1, 0, 0, 1}));
    EXPECT_EQ(run.real(1), (pipeline::Lanes{1, 0, 0, 1}));
    EXPECT_EQ(run.quad.alive(), 0b0110U);
}

TEST(SpirvControl, AnEndlessLoopExceedsTheBudget) {
    SpirvAssembler a;
    loop(a, a.constant(2'000'000'000), [&](Id, Id next, Id) { a.write(Op::branch, {next}); });
    const auto words = a.module();
    SpirvRun run(words, 10'000);
    try {
        run.run();
        FAIL() << "it ended";
    } catch (const sim::InputError& error) {
        EXPECT_STREQ(error.what(), "SPIR-V: entry point 'main' needs more than 10000 instructions");
    }
}

TEST(SpirvControl, InstructionsAreCounted) {
    SpirvAssembler a;
    const Id real = a.real(), x = a.load(a.input(real, 0), real);
    a.store(a.output(real, 0), a.result(Op::f_add, real, {x, x}));
    SpirvRun run(a.module());
    run.run();
    EXPECT_EQ(run.quad.instructions(), (LaneWords{4, 4, 4, 4})); // load, add, store, return
}

TEST(SpirvControl, LargeProgramsOfNestedCallsAreRefused) {
    // Each function calls the next one twice: 2^30 operations if all were put in place, or as many calls of nothing.
    for (const bool empty : {false, true}) {
        SpirvAssembler a;
        const Id real = a.real();
        std::vector<Id> functions;
        for (int i = 0; i < 31; ++i) functions.push_back(a.id());
        a.result(Op::function_call, real, {functions[0], a.constant(1.0F)});
        for (std::size_t i = 0; i < functions.size(); ++i) {
            const auto x = a.begin_function(functions[i], real, {real});
            Id value = empty ? x[0] : a.result(Op::f_add, real, {x[0], x[0]});
            if (i + 1 < functions.size())
                for (int twice = 0; twice < 2; ++twice)
                    value = a.result(Op::function_call, real, {functions[i + 1], empty ? x[0] : value});
            a.write(Op::return_value, {empty ? x[0] : value});
            a.end_function();
        }
        EXPECT_NE(error_of(a.module()).find("expected a "), std::string::npos) << error_of(a.module());
    }
    SpirvAssembler a;
    const Id nothing = a.nothing();
    std::vector<Id> functions;
    for (int i = 0; i < 31; ++i) functions.push_back(a.id());
    a.result(Op::function_call, nothing, {functions[0]});
    for (std::size_t i = 0; i < functions.size(); ++i) {
        a.begin_function(functions[i], nothing, {});
        for (int twice = 0; twice < 2 && i + 1 < functions.size(); ++twice)
            a.result(Op::function_call, nothing, {functions[i + 1]});
        a.write(Op::return_nothing, {});
        a.end_function();
    }
    EXPECT_NE(error_of(a.module()).find("expected a smaller shader"), std::string::npos) << error_of(a.module());
}

} // namespace spirv_control_test
