#include <array>

#include "lab/experiments/avoidance/avoidance.hpp"
#include "lab/experiments/blind_layer/blind_layer.hpp"
#include "lab/experiments/blind_layer/self_filter.hpp"
#include "lab/experiments/cameras/camera_count.hpp"
#include "lab/experiments/campaign/campaign.hpp"
#include "lab/experiments/experiment.hpp"
#include "lab/experiments/film/film.hpp"
#include "lab/experiments/hidden_hand/hidden_hand.hpp"
#include "lab/experiments/interference/interference.hpp"
#include "lab/experiments/real_sensors/real_sensors.hpp"
#include "lab/experiments/real_task/real_task.hpp"
#include "lab/experiments/shadow/shadow.hpp"
#include "lab/experiments/timing/timing.hpp"

namespace depthgrid::experiments {

namespace {

constexpr std::array kExperiments{
    Experiment{"shadow", "a person between camera and robot: distances with one camera and with two", run_shadow},
    Experiment{"hidden-hand", "a hand behind the robot: distances with one camera and with two", run_hidden_hand},
    Experiment{"blind-layer", "a hand near a link: what it reads, by the padding of the robot", run_blind_layer},
    Experiment{"self-filter", "the same hand: rules that delete, mask or remove the robot's pixels", run_self_filter},
    Experiment{"interference", "two Kinects that disturb each other, and one of them vibrating", run_interference},
    Experiment{"cameras", "one to eight cameras: time, gray area, pockets behind the robot", run_camera_count},
    Experiment{"avoidance", "the letter's Fig. 15: a hexagon, a person with a box, the arm avoids",
               run_avoidance_experiment},
    Experiment{"film", "the same arm and a Kinect's noise, without and with what is declared: frames of a film",
               run_film},
    Experiment{"real-sensors", "simulated Kinects and D4xx without and with what is declared: distances, clear links",
               run_real_sensors},
    Experiment{"real-task", "the hexagon with a simulated Kinect's noise: task time, contacts", run_real_task},
    Experiment{"timing", "the avoidance loop on the real clock: cycles a second, cycles in time", run_timing, "two"},
    Experiment{"campaign", "many random people beside an arm that avoids them: contacts, distances, task time",
               run_campaign, "all"},
};

}  // namespace

std::span<const Experiment> experiments() noexcept { return kExperiments; }

}  // namespace depthgrid::experiments
