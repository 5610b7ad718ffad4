// The mutations that show what each case of ropsim stability guards; mutate.py runs them.
#include "reports/stability/catalogue.hpp"
#include "reports/toml_reader.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"

#include <gtest/gtest.h>
#include <set>

namespace mutations_test {

struct Replacement {
    std::string file, from, to;
    std::size_t occurrence = 0; ///< 0: the only one
};

struct Mutation {
    std::string id;
    std::vector<Replacement> replacements;
    std::vector<std::string> cases;
};

Replacement read_replacement(reports::TomlTable& table) {
    return {table.text("file"), table.text("from"), table.text("to"),
            static_cast<std::size_t>(table.number_or("occurrence", 0))};
}

std::vector<Mutation> read_mutations() {
    std::vector<Mutation> all;
    reports::read_toml_file(
        ropsim_test::source_dir() / "tests/stability/mutations.toml", [&](reports::TomlTable& root) {
            root.tables("mutation", [&](reports::TomlTable& table) {
                Mutation mutation{table.text("id"), {read_replacement(table)}, table.texts("cases")};
                table.tables(
                    "also", [&](reports::TomlTable& more) { mutation.replacements.push_back(read_replacement(more)); });
                all.push_back(std::move(mutation));
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
    for (const Mutation& mutation : read_mutations()) {
        SCOPED_TRACE(mutation.id);
        EXPECT_TRUE(ids.insert(mutation.id).second);
        EXPECT_FALSE(mutation.cases.empty());
        for (const Replacement& one : mutation.replacements) {
            EXPECT_NE(one.from, one.to);
            const std::size_t found =
                occurrences(ropsim_test::file_text(ropsim_test::source_dir() / one.file), one.from);
            EXPECT_TRUE(one.occurrence == 0 ? found == 1 : one.occurrence <= found)
                << found << " of '" << one.from << "' in " << one.file;
        }
    }
    EXPECT_GT(ids.size(), 100U);
}

TEST(StabilityMutations, EveryCaseIsNamedByOneAndNoOthersAre) {
    std::set<std::string> named;
    for (const Mutation& mutation : read_mutations()) named.insert(mutation.cases.begin(), mutation.cases.end());
    for (const reports::stability::Case& one : reports::stability::catalogue())
        EXPECT_EQ(named.erase(one.id), 1U) << one.id << " is named by no mutation";
    for (const std::string& id : named) ADD_FAILURE() << id << " is no case";
}

} // namespace mutations_test
