// Every case of ropsim stability as a test of its own, and the catalogue as a whole.
#include "reports/stability/catalogue.hpp"
#include "reports/stability/report.hpp"
#include "tests/support/program_run.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>

namespace stability_test {

using reports::stability::Case;
using reports::stability::catalogue;
using reports::stability::Outcome;
using reports::stability::Side;

std::vector<std::string> ids(bool is_long) {
    std::vector<std::string> found;
    for (const Case& one : catalogue())
        if (one.is_long == is_long) found.push_back(one.id);
    return found;
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
    std::string name = info.param;
    for (char& letter : name)
        if (std::isalnum(static_cast<unsigned char>(letter)) == 0) letter = '_';
    return name;
}

class Stability : public ::testing::TestWithParam<std::string> {
  protected:
    static void expect_good(const std::string& id) {
        const Outcome outcome = reports::stability::run(*reports::stability::cases_matching(id).front());
        EXPECT_TRUE(outcome.ok) << "expected " << outcome.of->expectation << "; " << outcome.text << "; error "
                                << outcome.error << " " << outcome.of->unit << ", bound " << outcome.of->bound;
    }
};
class StabilityLong : public Stability {};

TEST_P(Stability, Case) { expect_good(GetParam()); }
TEST_P(StabilityLong, Case) { expect_good(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Catalogue, Stability, ::testing::ValuesIn(ids(false)), test_name);
INSTANTIATE_TEST_SUITE_P(Catalogue, StabilityLong, ::testing::ValuesIn(ids(true)), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(StabilityLong);

TEST(StabilityCatalogue, IdsAreUniqueAndEveryCaseSaysWhatItIs) {
    std::set<std::string> seen;
    for (const Case& one : catalogue()) {
        EXPECT_TRUE(seen.insert(one.id).second) << one.id;
        EXPECT_NE(one.id.find('.'), std::string::npos) << one.id;
        EXPECT_EQ(one.id.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789.-"), std::string::npos) << one.id;
        EXPECT_FALSE(one.subject.empty() || one.expectation.empty()) << one.id;
        EXPECT_TRUE(one.bound == 0.0 || !one.unit.empty()) << one.id;
    }
}

// What the lists of the specification and of the design ask for; each with a limit has a case on either side of it.
TEST(StabilityCatalogue, AFindingFailsAboveItsBoundAndForWhatIsNotANumber) {
    const auto outcome_of = [](double error, double bound) {
        const Case one{"a.b",
                       Side::whole,
                       "s",
                       "e",
                       "u",
                       bound,
                       [error](reports::stability::Finding& finding) { finding.error(error); }};
        return reports::stability::run(one).ok;
    };
    EXPECT_TRUE(outcome_of(1.0, 1.0));
    EXPECT_TRUE(outcome_of(-1.0, 1.0));
    EXPECT_FALSE(outcome_of(1.01, 1.0));
    EXPECT_FALSE(outcome_of(-1.01, 1.0));
    EXPECT_FALSE(outcome_of(std::numeric_limits<double>::quiet_NaN(), 1e300));
    const Case thrower{
        "a.b", Side::whole, "s", "e", "", 0.0, [](reports::stability::Finding&) { throw std::runtime_error("bad"); }};
    EXPECT_FALSE(reports::stability::run(thrower).ok);
    const Case silent{"a.b",
                      Side::whole,
                      "s",
                      "e",
                      "",
                      0.0,
                      [](reports::stability::Finding& finding) { finding.refuses([] {}, "no"); }};
    EXPECT_FALSE(reports::stability::run(silent).ok);
}

TEST(StabilityCatalogue, TheProgramWritesTablesAndAPage) {
    const ropsim_test::TemporaryFolder folder;
    const auto outcome = ropsim_test::run_program(
        {"stability", "--filter", "half.*", "--json", "--no-images", "--out", folder.path().string()});
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    const auto document = nlohmann::json::parse(outcome.out);
    for (const char* key : {"id", "subject", "side", "expectation", "outcome", "error", "unit", "ok"})
        EXPECT_TRUE(document["cases"][0].contains(key)) << key;
    EXPECT_EQ(document["summary"]["failed"], 0);
    for (const char* file : {"stability.json", "stability.csv", "conditioning.csv", "report.html"})
        EXPECT_TRUE(std::filesystem::exists(folder.path() / file)) << file;
}

} // namespace stability_test
