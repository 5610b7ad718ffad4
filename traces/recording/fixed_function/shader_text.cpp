#include "traces/recording/fixed_function/shader_text.hpp"

#include <algorithm>

namespace traces::fixed_function {

bool ShaderText::declares(const std::string& name) const { return std::ranges::find(names_, name) != names_.end(); }

bool ShaderText::declare(const std::string& name, const std::string& text) {
    if (declares(name)) return false;
    names_.push_back(name);
    if (!text.empty()) declarations_ += text + ";\n";
    return true;
}

std::string ShaderText::sampler(const std::string& type, const std::string& name) {
    declare(name, "uniform " + type + " " + name);
    return name;
}

std::string ShaderText::input(const std::string& type, const std::string& name, bool flat) {
    if (declare(name, (flat ? "flat in " : "in ") + type + " " + name)) inputs_.push_back(name);
    return name;
}

std::string ShaderText::output(const std::string& type, const std::string& name, bool flat) {
    declare(name, (flat ? "flat out " : "out ") + type + " " + name);
    return name;
}

std::string ShaderText::local(const std::string& type, const std::string& name, const std::string& expression) {
    if (declare(name, "")) statement(type + " " + name + " = " + expression);
    return name;
}

void ShaderText::function(const std::string& name, const std::string& text) {
    if (declare(name, "")) functions_ += text;
}

// 1.40 is the first version with rectangle textures; flat and clip distances came with 1.30, gl_FragColor is still
// there.
std::string ShaderText::source() const {
    return "#version 140\n" + declarations_ + functions_ + "void main() {\n" + body_ + "}\n";
}

} // namespace traces::fixed_function
