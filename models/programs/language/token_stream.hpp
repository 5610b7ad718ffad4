// Tokens one after the other, for a parser that looks one ahead.
#pragma once

#include "models/programs/language/lexer.hpp"

#include <fmt/format.h>

namespace models::language {

class TokenStream {
  public:
    explicit TokenStream(const Source& source) : source_(&source), tokens_(tokens_of(source)) {}

    const Token& peek() const { return tokens_[next_]; }
    Token take() {
        Token token = tokens_[next_];
        if (token.kind != TokenKind::end) ++next_;
        return token;
    }

    bool sees(std::string_view text) const {
        const TokenKind kind = peek().kind;
        return (kind == TokenKind::word || kind == TokenKind::sign) && peek().text == text;
    }
    bool accept(std::string_view text) {
        if (!sees(text)) return false;
        ++next_;
        return true;
    }
    Place expect(std::string_view text) {
        if (!sees(text)) fail(fmt::format("'{}'", text));
        return take().place;
    }
    Token expect(TokenKind kind, std::string_view expected) {
        if (peek().kind != kind) fail(expected);
        return take();
    }

    [[noreturn]] void fail(std::string_view expected) const {
        complain(*source_, peek().place, expected, quoted(peek()));
    }

  private:
    const Source* source_;
    std::vector<Token> tokens_;
    std::size_t next_ = 0;
};

} // namespace models::language
