#include <array>

#include "depthgrid/experiments/avoidance.hpp"
#include "depthgrid/experiments/camera_count.hpp"
#include "depthgrid/experiments/campaign.hpp"
#include "depthgrid/experiments/experiment.hpp"
#include "depthgrid/experiments/hidden_hand.hpp"
#include "depthgrid/experiments/interference.hpp"
#include "depthgrid/experiments/shadow.hpp"
#include "depthgrid/experiments/timing.hpp"

namespace depthgrid::experiments {

namespace {

constexpr std::array kExperiments{
    Experiment{"shadow", "a person between camera and robot: distances with one camera and with two", run_shadow},
    Experiment{"hidden-hand", "a hand behind the robot: distances with one camera and with two", run_hidden_hand},
    Experiment{"interference", "two Kinects that disturb each other, and one of them vibrating", run_interference},
    Experiment{"cameras", "one to eight cameras: time, gray area, pockets behind the robot", run_camera_count},
    Experiment{"avoidance", "the letter's Fig. 15: a hexagon, a person with a box, the arm avoids",
               run_avoidance_experiment},
    Experiment{"timing", "the avoidance loop on the real clock: cycles a second, cycles in time", run_timing, "two"},
    Experiment{"campaign", "many random people beside an arm that avoids them: contacts, distances, task time",
               run_campaign, "all"},
};

}  // namespace

std::span<const Experiment> experiments() noexcept { return kExperiments; }

}  // namespace depthgrid::experiments
