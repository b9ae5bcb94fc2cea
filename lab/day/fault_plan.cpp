#include "lab/day/fault_plan.hpp"

#include <algorithm>

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/pixel_random.hpp"
#include "lab/measure/json_file.hpp"

namespace depthgrid::lab {
namespace {

constexpr std::array<std::string_view, kDeviceFaults.size()> kFaultNames{
    "drop",       "delay",      "freeze",     "reorder", "duplicate", "black",
    "wrong size", "fast clock", "slow clock", "unplug",  "restart",   "network"};

constexpr double kFirst_s = 4;
constexpr double kShortest_s = 0.6;
constexpr double kSpread_s = 1.4;
constexpr double kLeastGap_s = 3;
constexpr double kGapSpread_s = 3;
constexpr double kNetworkGap_s = 20;

DeviceFault fault_of(std::string_view name) {
  const auto* const found = std::find(kFaultNames.begin(), kFaultNames.end(), name);
  if (found == kFaultNames.end()) {
    fail("there is no fault '", name, "'");
  }
  return kDeviceFaults.at(static_cast<std::size_t>(found - kFaultNames.begin()));
}

/// One after the other, uniform in [0, 1).
class Dice {
 public:
  Dice(std::uint64_t seed, std::uint64_t stream) : random_(seed, 0, stream) {}
  double next() { return random_.uniform(at_++); }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(next() * static_cast<double>(count)); }

 private:
  simulation::PixelRandom random_;
  std::uint64_t at_ = 0;
};

void add_faults(std::vector<PlannedFault>& plan, const std::string& device, const std::vector<DeviceFault>& kinds,
                double seconds, Dice dice) {
  const std::vector<PlannedFault> network = plan;
  for (double at_s = kFirst_s + kLeastGap_s * dice.next(); at_s < seconds;) {
    const DeviceFault kind = kinds[dice.below(kinds.size())];
    const double length_s = kind == DeviceFault::restart ? 0.01 : kShortest_s + kSpread_s * dice.next();
    const double end_s = at_s + length_s;
    const bool is_free = std::none_of(network.begin(), network.end(), [&](const PlannedFault& other) {
      return other.device == device && at_s < other.end_s + kLeastGap_s && other.begin_s < end_s + kLeastGap_s;
    });
    if (is_free && end_s + kLeastGap_s < seconds) {
      plan.push_back({device, kind, at_s, end_s});
    }
    at_s = end_s + kLeastGap_s + kGapSpread_s * dice.next();
  }
}

}  // namespace

std::string_view to_string(DeviceFault fault) noexcept { return kFaultNames[static_cast<std::size_t>(fault)]; }

bool hides(DeviceFault fault) noexcept {
  switch (fault) {
    case DeviceFault::drop:
    case DeviceFault::delay:
    case DeviceFault::freeze:
    case DeviceFault::fast_clock:
    case DeviceFault::slow_clock:
    case DeviceFault::unplug:
    case DeviceFault::network:
      return true;
    default:
      return false;
  }
}

std::vector<PlannedFault> random_faults(const std::vector<std::string>& cameras, double seconds, std::uint64_t seed) {
  std::vector<PlannedFault> plan;
  std::vector<std::string> devices = cameras;
  devices.emplace_back(kJointsDevice);
  Dice network(seed, 0);
  for (double at_s = kNetworkGap_s * (0.5 + network.next()); at_s + 2 * kLeastGap_s < seconds;
       at_s += kNetworkGap_s * (0.5 + network.next())) {
    const double end_s = at_s + kShortest_s + kSpread_s * network.next();
    for (const std::string& device : devices) {
      plan.push_back({device, DeviceFault::network, at_s, end_s});
    }
  }
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const bool is_camera = i < cameras.size();
    std::vector<DeviceFault> kinds;
    for (const DeviceFault kind : kDeviceFaults) {
      const bool of_images = kind == DeviceFault::freeze || kind == DeviceFault::black;
      if (kind != DeviceFault::network && (is_camera || !of_images)) {
        kinds.push_back(kind);
      }
    }
    add_faults(plan, devices[i], kinds, seconds, Dice(seed, i + 1));
  }
  std::stable_sort(plan.begin(), plan.end(),
                   [](const PlannedFault& a, const PlannedFault& b) { return a.begin_s < b.begin_s; });
  return plan;
}

void write_plan(const std::filesystem::path& file, const DayPlan& plan) {
  Json json;
  json["begin_s"] = plan.begin_s;
  json["seconds"] = plan.seconds;
  json["image_rate_hz"] = plan.image_rate_hz;
  json["joint_rate_hz"] = plan.joint_rate_hz;
  json["faults"] = Json::array();
  for (const PlannedFault& fault : plan.faults) {
    json["faults"].push_back({{"device", fault.device},
                              {"fault", std::string(to_string(fault.fault))},
                              {"begin_s", fault.begin_s},
                              {"end_s", fault.end_s}});
  }
  write_json_file(file, json);
}

DayPlan read_plan(const std::filesystem::path& file) {
  const Json json =
      read_json_file(file, "plan of faults", {"begin_s", "seconds", "image_rate_hz", "joint_rate_hz", "faults"});
  return taken_apart(file.string(), "plan of faults", [&] {
    DayPlan plan;
    plan.begin_s = json.at("begin_s").get<double>();
    plan.seconds = json.at("seconds").get<double>();
    plan.image_rate_hz = json.at("image_rate_hz").get<double>();
    plan.joint_rate_hz = json.at("joint_rate_hz").get<double>();
    for (const Json& fault : json.at("faults")) {
      plan.faults.push_back({fault.at("device").get<std::string>(), fault_of(fault.at("fault").get<std::string>()),
                             fault.at("begin_s").get<double>(), fault.at("end_s").get<double>()});
    }
    return plan;
  });
}

}  // namespace depthgrid::lab
