#include <array>

#include "depthgrid/experiments/experiment.hpp"
#include "depthgrid/experiments/shadow.hpp"

namespace depthgrid::experiments {

namespace {

constexpr std::array kExperiments{
    Experiment{"shadow", "a person between camera and robot: distances with one camera and with two", run_shadow},
};

}  // namespace

std::span<const Experiment> experiments() noexcept { return kExperiments; }

}  // namespace depthgrid::experiments
