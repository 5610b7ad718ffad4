// predictions.toml: what theory says of the model, number by number.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace physics {

/// One run of the model, in the words of the command line.
struct PredictionRun {
    std::string name; ///< unique in its row; of a series NAME_VALUE, with _ for - and .
    std::string scene, workload, gpu, design;
    std::uint32_t width = 0, height = 0;
    std::vector<std::string> workload_settings, settings;
};

struct Prediction {
    enum class Status : std::uint8_t { holds, refuted };
    enum class Effort : std::uint8_t { quick, long_ };

    std::string id;        ///< "R1"
    std::string claim;     ///< what theory says
    std::string tolerance; ///< what the tolerances of `expectations` come from
    Status status = Status::holds;
    Effort effort = Effort::quick;
    std::string mechanism; ///< refuted only: what real hardware does, and the source; `expectations` test it
    std::string test;      ///< where no expression of numbers can say it: the test, "PhysicsStreams.PHY_C1_Lru"
    std::vector<PredictionRun> runs;
    std::vector<std::string> expectations; ///< see judge()

    /// "PHY_R1"; with "_Long" behind it when it takes long, which is how the quick tests leave it out.
    std::string test_name() const;
};

/// All rows in their order. Throws sim::InputError with file, line and what was expected.
std::vector<Prediction> read_predictions();

} // namespace physics
