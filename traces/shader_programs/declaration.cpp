#include "traces/shader_programs/declaration.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fmt/format.h>
#include <string_view>

namespace traces::shader_programs {

namespace {

struct Token {
    std::string text; ///< a word, a number or one sign; of a text between quotes, with the first quote
    std::uint32_t line = 1;
    bool directive = false; ///< on a line that begins with #
};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

class Scanner {
  public:
    explicit Scanner(const std::string& text) : text_(text) {}

    std::vector<Token> tokens() {
        while (at_ < text_.size()) step();
        return std::move(tokens_);
    }
    std::uint32_t lines() const { return line_; }

  private:
    char next(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

    void step() {
        const char c = next();
        if (c == '\n') {
            ++line_, ++at_;
            directive_ = false;
        } else if (std::isspace(static_cast<unsigned char>(c)) != 0) {
            ++at_;
        } else if (c == '/' && next(1) == '/') {
            at_ = std::min(text_.find('\n', at_), text_.size());
        } else if (c == '/' && next(1) == '*') {
            const std::size_t end = std::min(text_.find("*/", at_ + 2), text_.size() - 2) + 2;
            line_ += static_cast<std::uint32_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                                           text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
            at_ = end;
        } else {
            directive_ |= c == '#';
            std::size_t end = at_ + 1;
            if (is_word(c))
                while (end < text_.size() && is_word(text_[end])) ++end;
            else if (c == '"' && directive_)
                end = std::min({text_.find('"', end), text_.find('\n', end), text_.size()});
            tokens_.push_back({text_.substr(at_, end - at_), line_, directive_});
            at_ = end + (c == '"' && directive_ && end < text_.size() && text_[end] == '"' ? 1 : 0);
        }
    }

    const std::string& text_;
    std::size_t at_ = 0;
    std::uint32_t line_ = 1;
    bool directive_ = false;
    std::vector<Token> tokens_;
};

struct Signature {
    std::string_view type, name;
};

/// By Function.
constexpr std::array<Signature, 5> signatures{
    {{"Entry", "entry"}, {"Entry", "empty"}, {"void", "modify"}, {"State", "initial"}, {"void", "drain"}}};

class Reader {
  public:
    explicit Reader(Declaration& declaration) : to_(declaration) {
        Scanner scanner(declaration.text);
        tokens_ = scanner.tokens();
        declaration.lines = scanner.lines();
    }

    void read() {
        while (at_ < tokens_.size()) {
            const Token& token = tokens_[at_];
            if (token.directive)
                directive();
            else if (token.text == "struct" && (word(1) == "Entry" || word(1) == "State"))
                structure();
            else
                code();
        }
        check();
    }

  private:
    std::string word(std::size_t ahead) const { return at_ + ahead < tokens_.size() ? tokens_[at_ + ahead].text : ""; }

    [[noreturn]] void complain(std::uint32_t line, const std::string& expected, const std::string& got) const {
        throw sim::InputError(fmt::format("{}:{}: expected {}, got {}", to_.name, line, expected,
                                          got.empty() ? "the end" : "'" + got + "'"));
    }

    void code() {
        const std::string& text = tokens_[at_].text;
        for (std::size_t i = 0; i < signatures.size(); ++i)
            if (text == signatures[i].type && word(1) == signatures[i].name && word(2) == "(")
                to_.function_lines[i] = tokens_[at_].line;
        to_.needs_colour |= text == "." && word(1) == "colour";
        ++at_;
    }

    std::vector<Token> rest_of_line() {
        std::vector<Token> rest;
        const std::uint32_t line = tokens_[at_].line;
        for (; at_ < tokens_.size() && tokens_[at_].line == line && tokens_[at_].directive; ++at_)
            rest.push_back(tokens_[at_]);
        return rest;
    }

    void directive();
    void structure();
    void check() const;
    std::uint32_t whole(const std::vector<Token>& line, std::size_t place) const;
    std::size_t one_of(const std::vector<Token>& line, std::initializer_list<std::string_view> names) const;

    Declaration& to_;
    std::vector<Token> tokens_;
    std::size_t at_ = 0;
    bool has_entry_ = false, has_state_ = false;
};

std::uint32_t Reader::whole(const std::vector<Token>& line, std::size_t place) const {
    const std::string text = place < line.size() ? line[place].text : "";
    std::uint32_t value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end.ec != std::errc() || end.ptr != text.data() + text.size() || value < 1 || value > 64)
        complain(line.front().line, "a number from 1 to 64", text);
    return value;
}

std::size_t Reader::one_of(const std::vector<Token>& line, std::initializer_list<std::string_view> names) const {
    const std::string text = line.size() > 3 ? line[3].text : "";
    const auto found = std::find(names.begin(), names.end(), text);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    std::string list;
    for (const std::string_view name : names) list += (list.empty() ? "" : " or ") + std::string(name);
    complain(line.front().line, list, text);
}

/// Those that are not the program's own are the compiler's.
void Reader::directive() {
    const std::vector<Token> line = rest_of_line();
    const auto text = [&](std::size_t i) { return i < line.size() ? line[i].text : std::string(); };
    if (text(1) == "version") complain(line[0].line, "no version, as the program is put behind one", "#version");
    if (text(1) != "pragma") return;
    if (text(2) == "program") {
        if (!text(3).starts_with('"')) complain(line[0].line, "a name between quotes", text(3));
        to_.id = text(3).substr(1);
        if (text(4).starts_with('"')) to_.summary = text(4).substr(1);
    } else if (text(2) == "k") {
        to_.default_k = to_.least_k = to_.most_k = whole(line, 3);
        if (line.size() == 4) return;
        if (text(4) != "from" || text(6) != "to") complain(line[0].line, "from ... to ...", text(4));
        to_.least_k = whole(line, 5);
        to_.most_k = whole(line, 7);
        if (to_.least_k > to_.default_k || to_.default_k > to_.most_k)
            complain(line[0].line, fmt::format("{} to lie from {} to {}", to_.default_k, to_.least_k, to_.most_k),
                     text(3));
    } else if (text(2) == "depth") {
        to_.depth = text(3);
    } else if (text(2) == "order") {
        to_.order =
            one_of(line, {"any", "primitive"}) == 0 ? pipeline::OrderNeed::any : pipeline::OrderNeed::primitive_order;
    } else if (text(2) == "peeling") {
        to_.peeling = one_of(line, {"none", "nearest"}) == 0 ? pipeline::Peeling::none : pipeline::Peeling::nearest;
    } else if (text(2) == "picture") {
        to_.picture = static_cast<Picture>(one_of(line, {"layers", "nodes", "state"}));
    }
}

/// struct Entry { float r, g, b; vec2 moments; };
void Reader::structure() {
    const bool entry = word(1) == "Entry";
    Fields& fields = entry ? to_.entry : to_.state;
    (entry ? has_entry_ : has_state_) = true;
    const auto line = [&] { return tokens_[std::min(at_, tokens_.size() - 1)].line; };
    const auto expect = [&](const char* sign) {
        if (word(0) != sign) complain(line(), fmt::format("'{}'", sign), word(0));
        ++at_;
    };
    at_ += 2;
    expect("{");
    while (word(0) != "}") {
        const std::string type = word(0);
        const std::uint32_t components = type == "float" ? 1
                                         : type == "vec2" || type == "vec3" || type == "vec4"
                                             ? static_cast<std::uint32_t>(type[3] - '0')
                                             : 0;
        if (components == 0) complain(line(), "float, vec2, vec3 or vec4", type);
        do {
            ++at_;
            const std::string name = word(0);
            if (name.empty() || !is_word(name[0])) complain(line(), "the name of a field", name);
            if (components == 1)
                fields.push_back(name);
            else
                for (std::uint32_t i = 0; i < components; ++i) fields.push_back(fmt::format("{}.{}", name, "xyzw"[i]));
            ++at_;
        } while (word(0) == ",");
        expect(";");
    }
    ++at_;
}

void Reader::check() const {
    const auto need = [&](bool there, const char* what) {
        if (!there) complain(to_.lines, what, "");
    };
    need(!to_.id.empty(), "a line '#pragma program \"NAME\"'");
    need(has_entry_, "a structure 'struct Entry { ... };'");
    if (to_.entry.empty() || to_.entry.size() > pipeline::largest_entry)
        throw sim::InputError(fmt::format("{}: expected entries of 1 to {} floats, got {}", to_.name,
                                          pipeline::largest_entry, to_.entry.size()));
    if (std::find(to_.entry.begin(), to_.entry.end(), to_.depth) == to_.entry.end())
        throw sim::InputError(fmt::format(
            "{}: expected a float '{}' in Entry, the depth; '#pragma depth NAME' names another", to_.name, to_.depth));
    const auto has = [&](Function function) { return to_.line_of(function) != 0; };
    need(has(Function::entry), "a function 'Entry entry(Fragment f)'");
    need(has(Function::empty), "a function 'Entry empty()'");
    need(has(Function::modify), has_state_ ? "a function 'void modify(inout Entry e[k], inout State s, Entry f)'"
                                           : "a function 'void modify(inout Entry e[k], Entry f)'");
    if (has_state_) need(has(Function::initial), "a function 'State initial()'");
    if (to_.picture == Picture::layers) return;
    const Fields& fields = to_.picture == Picture::nodes ? to_.entry : to_.state;
    for (const char* name : {"r", "g", "b", "t"})
        if (std::find(fields.begin(), fields.end(), name) == fields.end())
            throw sim::InputError(
                fmt::format("{}: expected floats r, g, b, t in {}, of which the picture is made; got no {}", to_.name,
                            to_.picture == Picture::nodes ? "Entry" : "State", name));
}

} // namespace

std::uint32_t Declaration::depth_slot() const {
    return static_cast<std::uint32_t>(std::find(entry.begin(), entry.end(), depth) - entry.begin());
}

Declaration declaration_of(std::string name, std::string text) {
    Declaration declaration;
    declaration.name = std::move(name);
    declaration.text = std::move(text);
    Reader(declaration).read();
    return declaration;
}

} // namespace traces::shader_programs
