// Registers that a shader needs at once.
#include "tests/support/spirv_assembler.hpp"
#include "traces/spirv/register_pressure.hpp"

#include <gtest/gtest.h>

namespace spirv_register_pressure_test {

using tests::SpirvAssembler;
using traces::spirv::Op;
using Id = SpirvAssembler::Id;

std::uint32_t pressure(const SpirvAssembler& a) {
    return traces::spirv::register_pressure(traces::spirv::Module(a.module()));
}

// The output, and in turn one value after the other.
TEST(SpirvRegisterPressure, AChainNeedsTwoValuesAtOnce) {
    for (const std::uint32_t length : {1U, 20U}) {
        SpirvAssembler a;
        const Id v4 = a.vector(a.real(), 4);
        Id value = a.load(a.input(v4, 0), v4);
        for (std::uint32_t i = 0; i < length; ++i) value = a.result(Op::f_add, v4, {value, value});
        a.store(a.output(v4, 0), value);
        EXPECT_EQ(pressure(a), 3U) << length;
    }
}

// All vectors are read before the first one is used.
TEST(SpirvRegisterPressure, ValuesThatAreKeptAddUp) {
    for (const std::uint32_t kept : {2U, 5U, 9U}) {
        SpirvAssembler a;
        const Id v4 = a.vector(a.real(), 4);
        std::vector<Id> values;
        for (std::uint32_t i = 0; i < kept; ++i) values.push_back(a.load(a.input(v4, i), v4));
        Id sum = values[0];
        for (std::uint32_t i = 1; i < kept; ++i) sum = a.result(Op::f_add, v4, {sum, values[i]});
        a.store(a.output(v4, 0), sum);
        EXPECT_EQ(pressure(a), kept + 2); // with the first sum, and the output
    }
}

TEST(SpirvRegisterPressure, ScalarsSharePartsOfRegistersAndVariablesStay) {
    SpirvAssembler a;
    const Id v4 = a.vector(a.real(), 4);
    a.local(a.array(v4, 7));
    a.store(a.output(a.real(), 0), a.load(a.input(a.real(), 0), a.real()));
    EXPECT_EQ(pressure(a), 8U); // 28 scalars of the array, one of the output, one that was read
}

} // namespace spirv_register_pressure_test
