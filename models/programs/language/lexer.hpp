// Words, numbers, texts and signs of a program in the k-buffer language.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace models::language {

struct Place {
    std::uint32_t line = 1, column = 1; ///< from 1; columns count bytes
};

enum class TokenKind : std::uint8_t { word, integer, number, text, sign, end };

struct Token {
    TokenKind kind = TokenKind::end;
    std::string text;   ///< as written; of a text, what is between the quotes
    double value = 0.0; ///< of numbers
    Place place;
};

/// A program's text and the name it has in messages.
struct Source {
    std::string name, text;
};

/// Throws sim::InputError "name:line:column: expected EXPECTED, got GOT".
[[noreturn]] void complain(const Source& source, Place place, std::string_view expected, std::string_view got);

/// "'word'", or "the end of the file".
std::string quoted(const Token& token);

/// All tokens; the last one is the end. Throws sim::InputError for a character that begins no token.
std::vector<Token> tokens_of(const Source& source);

} // namespace models::language
