#include "models/programs/language/parser.hpp"

#include "models/programs/language/expression_parser.hpp"

#include <algorithm>
#include <array>
#include <fmt/ranges.h>
#include <utility>

namespace models::language {

namespace {

class Parser {
  public:
    explicit Parser(Source source) : program_(std::move(source)), tokens_(program_.source), expressions_(tokens_) {}

    Program run() {
        if (!tokens_.sees("program")) tokens_.fail("'program'");
        while (!tokens_.sees("fragment")) header();
        tokens_.take();
        program_.fragment = block();
        program_.has_drain = tokens_.accept("drain");
        if (program_.has_drain) program_.drain = block();
        if (tokens_.peek().kind != TokenKind::end)
            tokens_.fail(program_.has_drain ? "the end of the file" : "'drain' or the end of the file");
        return std::move(program_);
    }

  private:
    void header() {
        const Place place = tokens_.peek().place;
        if (tokens_.accept("program")) {
            name();
        } else if (tokens_.accept("k")) {
            range_of_k();
        } else if (tokens_.accept("entry")) {
            entry();
        } else if (tokens_.accept("empty")) {
            definitions(program_.empty);
        } else if (tokens_.accept("state")) {
            definitions(program_.state);
        } else if (tokens_.accept("constant")) {
            definitions(program_.constants);
        } else if (tokens_.accept("depth")) {
            program_.depth_place = tokens_.peek().place;
            program_.depth = tokens_.expect(TokenKind::word, "a field of the entry").text;
        } else if (tokens_.accept("order")) {
            program_.order = choice<pipeline::OrderNeed>({"any", "primitive"});
        } else if (tokens_.accept("peeling")) {
            program_.peeling = choice<pipeline::Peeling>({"none", "nearest"});
        } else if (tokens_.accept("picture")) {
            program_.picture_place = place;
            program_.picture = choice<Picture>({"layers", "nodes", "state"});
        } else {
            tokens_.fail(
                "'program', 'k', 'entry', 'empty', 'state', 'constant', 'depth', 'order', 'peeling', 'picture' "
                "or 'fragment'");
        }
        tokens_.expect(";");
    }

    void name() {
        program_.id = tokens_.expect(TokenKind::text, "the program's name in quotes").text;
        if (tokens_.peek().kind == TokenKind::text) program_.summary = tokens_.take().text;
    }

    /// The number of the word that comes next.
    template <class E>
    E choice(const std::vector<std::string_view>& words) {
        for (std::size_t i = 0; i < words.size(); ++i)
            if (tokens_.accept(words[i])) return static_cast<E>(i);
        tokens_.fail(fmt::format("'{}'", fmt::join(words, "' or '")));
    }

    std::uint32_t k_value(std::uint32_t least) {
        const Token token = tokens_.expect(TokenKind::integer, "a whole number");
        if (token.value < least || token.value > 64.0)
            complain(program_.source, token.place, fmt::format("{} to 64", least), quoted(token));
        return static_cast<std::uint32_t>(token.value);
    }

    // k 4; or k 4 from 1 to 64;
    void range_of_k() {
        const Place place = tokens_.peek().place;
        program_.default_k = program_.least_k = program_.most_k = k_value(1);
        if (tokens_.accept("from")) {
            program_.least_k = k_value(1);
            tokens_.expect("to");
            program_.most_k = k_value(program_.least_k);
        }
        if (program_.default_k < program_.least_k || program_.default_k > program_.most_k)
            complain(program_.source, place, fmt::format("{} to {}", program_.least_k, program_.most_k),
                     fmt::format("'{}'", program_.default_k));
    }

    // A field without a value is the shader's of that name.
    void entry() {
        do {
            const Token word = tokens_.expect(TokenKind::word, "a field");
            Definition field{word.place, word.text, {}};
            if (tokens_.accept("=")) {
                field.value = expressions_.expression();
            } else {
                field.value.place = word.place;
                field.value.kind = Expression::Kind::reference;
                field.value.name = "f";
                field.value.field = word.text;
            }
            program_.entry.push_back(std::move(field));
        } while (tokens_.accept(","));
    }

    void definitions(std::vector<Definition>& list) {
        do {
            const Token word = tokens_.expect(TokenKind::word, "a name");
            tokens_.expect("=");
            list.push_back({word.place, word.text, expressions_.expression()});
        } while (tokens_.accept(","));
    }

    std::vector<Statement> block() {
        tokens_.expect("{");
        if (++nesting_ > deepest_nesting) tokens_.fail(fmt::format("at most {} nested blocks", deepest_nesting));
        std::vector<Statement> statements;
        while (!tokens_.accept("}")) {
            if (tokens_.peek().kind == TokenKind::end) tokens_.fail("a statement or '}'");
            statements.push_back(statement());
        }
        --nesting_;
        return statements;
    }

    Statement statement() {
        Statement result;
        result.place = tokens_.peek().place;
        if (tokens_.sees("if")) return branch();
        if (tokens_.accept("for")) {
            result.kind = Statement::Kind::loop;
            result.name = tokens_.expect(TokenKind::word, "a name").text;
            tokens_.expect("in");
            result.operands.push_back(expressions_.expression());
            tokens_.expect("..");
            result.operands.push_back(expressions_.expression());
            result.body = block();
            return result;
        }
        if (tokens_.accept("swap")) {
            result.kind = Statement::Kind::swap;
            result.operands.push_back(expressions_.reference());
            tokens_.expect(",");
            result.operands.push_back(expressions_.reference());
        } else if (!declaration(result)) {
            if (tokens_.peek().kind != TokenKind::word) tokens_.fail("a statement or '}'");
            result.operands.push_back(expressions_.reference());
            tokens_.expect("=");
            result.operands.push_back(expressions_.expression());
        }
        tokens_.expect(";");
        return result;
    }

    bool declaration(Statement& result) {
        constexpr std::array<std::pair<std::string_view, Type>, 3> types{
            {{"float", Type::number}, {"int", Type::integer}, {"bool", Type::boolean}}};
        for (const auto& [word, type] : types)
            if (tokens_.accept(word)) {
                result.kind = Statement::Kind::declare;
                result.type = type;
                result.place = tokens_.peek().place;
                result.name = tokens_.expect(TokenKind::word, "a name").text;
                tokens_.expect("=");
                result.operands.push_back(expressions_.expression());
                return true;
            }
        return false;
    }

    Statement branch() {
        Statement result;
        result.kind = Statement::Kind::branch;
        result.place = tokens_.expect("if");
        if (++nesting_ > deepest_nesting) tokens_.fail(fmt::format("at most {} nested blocks", deepest_nesting));
        result.operands.push_back(expressions_.expression());
        result.body = block();
        if (tokens_.accept("else")) {
            if (tokens_.sees("if"))
                result.otherwise.push_back(branch());
            else
                result.otherwise = block();
        }
        --nesting_;
        return result;
    }

    Program program_;
    TokenStream tokens_; ///< of program_.source
    ExpressionParser expressions_;
    std::uint32_t nesting_ = 0;
};

} // namespace

Program parse(Source source) { return Parser(std::move(source)).run(); }

} // namespace models::language
