// The mutations that show what each case of ropsim stability guards; mutate.py runs them.
#include "reports/stability/catalogue.hpp"
#include "reports/toml_reader.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"

#include <gtest/gtest.h>
#include <set>

namespace mutations_test {

struct Mutation {
    std::string id, file, from, to;
    std::size_t occurrence = 0; ///< 0: the only one
    std::vector<std::string> cases;
};

struct Mutations {
    std::vector<Mutation> mutations;
    std::vector<std::string> redundant; ///< cases with more than one guard
};

Mutations read_mutations() {
    Mutations all;
    reports::read_toml_file(
        ropsim_test::source_dir() / "tests/stability/mutations.toml", [&](reports::TomlTable& root) {
            root.tables("mutation", [&](reports::TomlTable& table) {
                all.mutations.push_back({table.text("id"), table.text("file"), table.text("from"), table.text("to"),
                                         static_cast<std::size_t>(table.number_or("occurrence", 0)),
                                         table.texts("cases")});
            });
            root.tables("redundant", [&](reports::TomlTable& table) {
                EXPECT_FALSE(table.text("reason").empty());
                for (const std::string& id : table.texts("cases")) all.redundant.push_back(id);
            });
        });
    return all;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST(StabilityMutations, EachGuardIsStillWhereItWas) {
    std::set<std::string> ids;
    for (const Mutation& mutation : read_mutations().mutations) {
        SCOPED_TRACE(mutation.id);
        EXPECT_TRUE(ids.insert(mutation.id).second);
        EXPECT_NE(mutation.from, mutation.to);
        EXPECT_FALSE(mutation.cases.empty());
        const std::size_t found =
            occurrences(ropsim_test::file_text(ropsim_test::source_dir() / mutation.file), mutation.from);
        EXPECT_TRUE(mutation.occurrence == 0 ? found == 1 : mutation.occurrence <= found)
            << found << " in " << mutation.file;
    }
    EXPECT_GT(ids.size(), 100U);
}

TEST(StabilityMutations, EveryCaseIsNamedByOneAndNoOthersAre) {
    const Mutations all = read_mutations();
    std::set<std::string> named(all.redundant.begin(), all.redundant.end());
    EXPECT_EQ(named.size(), all.redundant.size());
    for (const Mutation& mutation : all.mutations) named.insert(mutation.cases.begin(), mutation.cases.end());
    for (const reports::stability::Case& one : reports::stability::catalogue())
        EXPECT_EQ(named.erase(one.id), 1U) << one.id << " is named by no mutation";
    for (const std::string& id : named) ADD_FAILURE() << id << " is no case";
}

} // namespace mutations_test
