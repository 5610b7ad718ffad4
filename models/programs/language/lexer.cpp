#include "models/programs/language/lexer.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <limits>

namespace models::language {

namespace {

constexpr std::size_t longest_quote = 40; ///< characters of a message's "got"

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool is_printable(char c) { return c >= ' ' && c <= '~'; }

std::string printable(std::string_view text) {
    std::string result;
    for (const char c : text.substr(0, longest_quote))
        result += is_printable(c) ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    return text.size() > longest_quote ? result + "..." : result;
}

class Lexer {
  public:
    explicit Lexer(const Source& source) : source_(source), left_(source.text) {}

    std::vector<Token> run() {
        std::vector<Token> tokens;
        do {
            skip_space();
            tokens.push_back(next());
        } while (tokens.back().kind != TokenKind::end);
        return tokens;
    }

  private:
    void skip_space() {
        while (!left_.empty() && (is_space(left_.front()) || left_.front() == '#')) {
            if (left_.front() == '#')
                advance(std::min(left_.find('\n'), left_.size()));
            else
                advance(1);
        }
    }

    void advance(std::size_t count) {
        for (const char c : left_.substr(0, count)) {
            ++place_.column;
            if (c == '\n') place_ = {place_.line + 1, 1};
        }
        left_.remove_prefix(count);
    }

    std::size_t count_while(std::size_t from, bool (*accepts)(char)) const {
        while (from < left_.size() && accepts(left_[from])) ++from;
        return from;
    }

    Token next() {
        if (left_.empty()) return {TokenKind::end, {}, 0.0, place_};
        if (is_letter(left_.front()))
            return take(TokenKind::word, count_while(0, [](char c) { return is_letter(c) || is_digit(c); }));
        if (is_digit(left_.front())) return number();
        if (left_.front() == '"') return text();
        for (const std::string_view sign : {"<=", ">=", "==", "!=", ".."})
            if (left_.starts_with(sign)) return take(TokenKind::sign, 2);
        constexpr std::string_view signs = "+-*/<>=(){}[],;.";
        if (signs.find(left_.front()) != std::string_view::npos) return take(TokenKind::sign, 1);
        complain(source_, place_, "a word, a number or a sign", fmt::format("'{}'", printable(left_.substr(0, 1))));
    }

    Token take(TokenKind kind, std::size_t length) {
        Token token{kind, std::string(left_.substr(0, length)), 0.0, place_};
        advance(length);
        return token;
    }

    // A range such as 0..4 is two dots after a whole number.
    Token number() {
        std::size_t end = count_while(0, is_digit);
        TokenKind kind = TokenKind::integer;
        if (end + 1 < left_.size() && left_[end] == '.' && is_digit(left_[end + 1])) {
            kind = TokenKind::number;
            end = count_while(end + 1, is_digit);
        }
        if (end < left_.size() && (left_[end] == 'e' || left_[end] == 'E')) {
            const std::size_t sign = end + 1 < left_.size() && (left_[end + 1] == '-' || left_[end + 1] == '+') ? 1 : 0;
            kind = TokenKind::number;
            end = count_while(end + 1 + sign, is_digit);
        }
        Token token = take(kind, std::min(end, left_.size()));
        const char* last = token.text.data() + token.text.size();
        const auto [stop, error] = std::from_chars(token.text.data(), last, token.value);
        const double most = kind == TokenKind::integer ? 16777216.0 : double{std::numeric_limits<float>::max()};
        if (error != std::errc() || stop != last || token.value > most)
            complain(source_, token.place,
                     kind == TokenKind::integer ? "a whole number up to 16777216" : "a number that a float can hold",
                     quoted(token));
        return token;
    }

    Token text() {
        const std::size_t end = left_.find_first_of("\"\n", 1);
        if (end == std::string_view::npos || left_[end] != '"')
            complain(source_, place_, "a text that ends on its line",
                     fmt::format("'{}'", printable(left_.substr(0, end))));
        Token token{TokenKind::text, std::string(left_.substr(1, end - 1)), 0.0, place_};
        if (!std::all_of(token.text.begin(), token.text.end(), is_printable))
            complain(source_, place_, "a text of printable characters", fmt::format("'{}'", printable(token.text)));
        advance(end + 1);
        return token;
    }

    const Source& source_;
    std::string_view left_;
    Place place_;
};

} // namespace

void complain(const Source& source, Place place, std::string_view expected, std::string_view got) {
    throw sim::InputError(
        fmt::format("{}:{}:{}: expected {}, got {}", source.name, place.line, place.column, expected, got));
}

std::string quoted(const Token& token) {
    return token.kind == TokenKind::end ? "the end of the file" : fmt::format("'{}'", printable(token.text));
}

std::vector<Token> tokens_of(const Source& source) { return Lexer(source).run(); }

} // namespace models::language
