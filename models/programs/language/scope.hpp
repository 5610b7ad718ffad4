// Names of variables and loops, block by block.
#pragma once

#include "models/programs/language/syntax.hpp"

#include <string>
#include <vector>

namespace models::language {

struct Binding {
    std::string name;
    Meaning meaning = Meaning::unknown;
    Type type = Type::number;
    std::uint32_t slot = 0;
};

class Scope {
  public:
    const Binding* find(std::string_view name) const {
        for (const Binding& binding : bindings_)
            if (binding.name == name) return &binding;
        return nullptr;
    }
    void add(Binding binding) { bindings_.push_back(std::move(binding)); }
    std::size_t size() const { return bindings_.size(); }
    /// Forgets what was added since there were `size` names.
    void shrink(std::size_t size) { bindings_.resize(size); }

    std::vector<std::string> names() const {
        std::vector<std::string> result;
        for (const Binding& binding : bindings_) result.push_back(binding.name);
        return result;
    }

  private:
    std::vector<Binding> bindings_;
};

} // namespace models::language
