// OpenGL 4.5 by llvmpipe without a window: contexts, and programs in the current one.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tests {

enum class MesaProfile { core, compatibility };

struct MesaContext {
    void *display = nullptr, *context = nullptr; ///< of EGL
};

/// @param reason why there is none
std::optional<MesaContext> create_mesa_context(MesaProfile profile, std::string& reason);

/// Makes a context current, and at its end the one that was, if any.
class CurrentMesaContext {
  public:
    explicit CurrentMesaContext(const MesaContext& context);
    ~CurrentMesaContext();
    CurrentMesaContext(const CurrentMesaContext&) = delete;
    CurrentMesaContext& operator=(const CurrentMesaContext&) = delete;

  private:
    MesaContext before_;
};

/// @param inputs those of the vertex shader, attribute 0 first
/// @return its name. Throws std::runtime_error with the driver's words where it has no such program.
unsigned link_program(const std::string& vertex, const std::string& fragment, const std::vector<std::string>& inputs);

} // namespace tests
