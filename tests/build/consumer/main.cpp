// Stands for somebody else's program: it uses an installed ropsim, and nothing of this repository.
#include "ropsim_build.hpp"
#include "sim/random.hpp"

#include <iostream>

int main() {
    sim::Random random(1, "consumer");
    const bool found = ropsim_build::find_data("models/gpus").has_value();
    std::cout << "ropsim " << ropsim_build::version << ", random " << random.below(6) << ", GPUs "
              << (found ? "found" : "missing") << '\n';
    return found ? 0 : 1;
}
