// Triangles placed on the screen, for cases that no generator makes.
#pragma once

#include "reports/stability/scenes.hpp"
#include "traces/generators/screen.hpp"

namespace support {

using reports::stability::screen_scene;
using reports::stability::ScreenTriangle;

} // namespace support
