#include "lab/day/day_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "lab/day/running_truth.hpp"
#include "report/number_text.hpp"

namespace depthgrid::lab {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostFindings = 20;
/// Times are written to the microsecond.
constexpr double kRounding_s = 3e-6;

double number(const nlohmann::json& json) { return json.is_number() ? json.get<double>() : kNaN; }

struct SeenCamera {
  std::string state;
  double image_s = kNaN;  ///< of the cell
  bool late = true;
};

struct SeenAnswer {
  double time_s = 0;
  bool stop = true;
  std::string state;
  double blind_m = kNaN;
  double latency_s = kNaN;
  double exposure_s = kNaN;
  double joints_s = kNaN;  ///< of the newest joint state
  std::vector<SeenCamera> cameras;
  std::vector<double> parts_m;
};

SeenAnswer seen(const std::string& line, std::uint64_t number_of_line, double begin_s, const DayInput& input) {
  try {
    const auto json = nlohmann::json::parse(line);
    SeenAnswer answer;
    answer.time_s = json.at("time_s").get<double>() - begin_s;
    answer.stop = json.at("stop").get<bool>();
    answer.state = json.at("state").get<std::string>();
    answer.blind_m = number(json.at("blind_m"));
    answer.latency_s = number(json.at("latency_s"));
    answer.exposure_s = number(json.at("exposure_s")) - begin_s;
    answer.joints_s = answer.time_s - number(json.at("joints_age_s"));
    for (const auto& camera : json.at("cameras")) {
      answer.cameras.push_back({camera.at("state").get<std::string>(), answer.time_s - number(camera.at("age_s")),
                                camera.at("late").get<bool>()});
    }
    for (const auto& part : json.at("parts")) {
      answer.parts_m.push_back(number(part.at("distance_m")));
    }
    if (answer.cameras.size() != input.setup.rig.cameras.size() || answer.parts_m.size() != input.setup.parts.size()) {
      fail("another number of cameras or parts than the cell has");
    }
    return answer;
  } catch (const std::exception& error) {
    fail("answers: line ", number_of_line, " is none of this cell: ", error.what());
  }
}

/// A fault that is under way or whose end is awaited.
struct Followed {
  PlannedFault plan;
  bool of_joints = false;
  std::size_t camera = 0;
  bool has_noticed = false;
  bool has_recovered = false;
};

class Checking {
 public:
  explicit Checking(const DayInput& input)
      : input_(input),
        simulated_(std::make_shared<sensors::SimulatedCell>(sensors::SimulatedCellSettings{
            .robot = input.setup.robot, .person = true, .seed = 1, .begin_s = input.plan.begin_s})),
        truth_(input.cell, input.setup, simulated_) {
    for (const PlannedFault& fault : input.plan.faults) {
      Followed followed{.plan = fault, .of_joints = fault.device == kJointsDevice, .camera = 0};
      while (!followed.of_joints && followed.camera < input.cell.cameras.size() &&
             input.cell.cameras[followed.camera].name != fault.device) {
        ++followed.camera;
      }
      if (!followed.of_joints && followed.camera == input.cell.cameras.size()) {
        fail("the plan's device '", fault.device, "' is not in the cell");
      }
      faults_.push_back(followed);
    }
  }

  void take(const SeenAnswer& answer) {
    if (report.answers == 0) {
      first_s_ = answer.time_s;
    } else {
      report.longest_gap_s = std::max(report.longest_gap_s, answer.time_s - last_s_);
    }
    last_s_ = answer.time_s;
    report.seconds = answer.time_s - first_s_;
    report.stopped += answer.stop ? 1 : 0;
    if (std::isfinite(answer.exposure_s) && answer.exposure_s != exposure_s_) {
      exposure_s_ = answer.exposure_s;
      report.latency_s.add(answer.latency_s);
    }
    if (report.answers % static_cast<std::uint64_t>(input_.truth_every) == 0) {
      compare(answer);
    }
    ++report.answers;
    look_at_silence(answer);
    for (Followed& fault : faults_) {
      if (fault.plan.begin_s <= answer.time_s && !(fault.has_recovered && fault.plan.end_s < answer.time_s)) {
        follow(fault, answer);
      }
    }
  }

  void end() {
    report.unclaimed = truth_.unclaimed();
    for (const Followed& fault : faults_) {
      // What ended with the answers had no time to recover.
      constexpr double kTime_s = 3;
      if (!fault.has_recovered && fault.plan.end_s + kTime_s < last_s_) {
        ++row(fault).never_recovered;
        ++report.never_recovered;
        find(fault.plan.end_s, fault.plan.device + " is not used again after " + name(fault));
      }
    }
    for (auto& [key, value] : rows_) {
      report.rows.push_back(std::move(value));
    }
  }

  DayReport report;

 private:
  static std::string name(const Followed& fault) { return std::string(to_string(fault.plan.fault)); }
  FaultRow& row(const Followed& fault) {
    FaultRow& result = rows_[{fault.of_joints, fault.plan.fault}];
    result.of = fault.of_joints ? "joints" : "camera";
    result.fault = fault.plan.fault;
    return result;
  }
  void find(double time_s, const std::string& what) {
    if (report.findings.size() < kMostFindings) {
      report.findings.push_back(report::fixed(time_s, 3) + " s: " + what);
    }
  }

  void compare(const SeenAnswer& answer) {
    if (!std::isfinite(answer.blind_m)) {
      return;
    }
    std::vector<UsedImage> images;
    for (std::size_t k = 0; k < answer.cameras.size(); ++k) {
      if (!answer.cameras[k].late) {
        images.push_back({k, answer.cameras[k].image_s});
      }
    }
    for (std::size_t i = 0; i < answer.parts_m.size(); ++i) {
      const double said_m = answer.parts_m[i];
      if (!std::isfinite(said_m)) {
        continue;
      }
      ++report.compared;
      constexpr std::uint64_t kSome = 101;
      if (report.compared % kSome == 0 && said_m > 0) {
        const double true_m = truth_.distance_m(i, answer.time_s);
        if (true_m < input_.cell.ask.rho_m) {
          report.margin_m.add(true_m - said_m);
        }
      }
      if (const auto excess_m = truth_.excess_m(i, answer.time_s, said_m, answer.blind_m, images)) {
        ++report.over_estimates;
        report.largest_excess_m = std::max(report.largest_excess_m, *excess_m);
        find(answer.time_s, input_.setup.parts[i].name + " is said to be " + report::fixed(said_m, 4) +
                                " m away, which is " + report::fixed(*excess_m, 4) + " m too far");
      }
    }
  }

  /// Moments that have to be stopped: no joint state, or no image, that is young enough. By the answer's own ages.
  void look_at_silence(const SeenAnswer& answer) {
    const bool no_joints = !(answer.time_s - answer.joints_s <= input_.cell.ages.joints_s + kRounding_s);
    const bool no_images = std::all_of(answer.cameras.begin(), answer.cameras.end(), [&](const SeenCamera& camera) {
      return !(answer.time_s - camera.image_s <= input_.cell.ages.image_s + kRounding_s);
    });
    if (no_joints || no_images) {
      must_stop(answer, no_joints ? "no joint state counts" : "no image counts");
    }
  }
  void must_stop(const SeenAnswer& answer, const std::string& why) {
    ++report.blind;
    if (!answer.stop || (answer.state != "no images" && answer.state != "no joint state")) {
      ++report.not_stopped;
      find(answer.time_s, "is not stopped though " + why);
    }
  }

  void follow(Followed& fault, const SeenAnswer& answer) {
    const double time_s = answer.time_s;
    const bool over = time_s >= fault.plan.end_s;
    if (fault.of_joints) {
      follow_joints(fault, answer, over);
    } else {
      follow_camera(fault, answer, over);
    }
  }

  void follow_joints(Followed& fault, const SeenAnswer& answer, bool over) {
    const bool silent = hides(fault.plan.fault) || fault.plan.fault == DeviceFault::wrong_size;
    const bool stopped = answer.stop && answer.state == "no joint state";
    if (silent && !over) {
      if (answer.joints_s > fault.plan.begin_s + kRounding_s) {
        ++report.hidden_used;
        find(answer.time_s, "a joint state is used that is no longer one: " + name(fault));
      }
      if (answer.time_s > fault.plan.begin_s + input_.cell.ages.joints_s + kRounding_s) {
        must_stop(answer, "the joints have been silent for long: " + name(fault));
      }
      if (stopped && !fault.has_noticed) {
        fault.has_noticed = true;
        row(fault).noticed_s.add(answer.time_s - fault.plan.begin_s);
      }
    }
    const double period_s = 1 / input_.plan.joint_rate_hz;
    if (over && !fault.has_recovered && answer.joints_s >= fault.plan.end_s && !stopped) {
      recovered(fault, (answer.joints_s - fault.plan.end_s) / period_s, answer.time_s);
    }
  }

  void follow_camera(Followed& fault, const SeenAnswer& answer, bool over) {
    const SeenCamera& camera = answer.cameras[fault.camera];
    const bool black = fault.plan.fault == DeviceFault::black;
    const bool wrong_size = fault.plan.fault == DeviceFault::wrong_size;
    // Until an image of the fault must have arrived, if one was sent at all, and until none before it may count.
    const double bound_s = fault.plan.begin_s + input_.cell.ages.image_s + kRounding_s;
    const bool told = black        ? camera.late || camera.state == "no reading"
                      : wrong_size ? camera.late || camera.state == "unusable"
                                   : camera.late;
    if ((hides(fault.plan.fault) || black || wrong_size) && !over) {
      const bool stands_on_it = camera.image_s > fault.plan.begin_s + kRounding_s && !camera.late;
      if (hides(fault.plan.fault) && stands_on_it) {
        ++report.hidden_used;
        find(answer.time_s, fault.plan.device + ": an image is used that is none: " + name(fault));
      }
      if (answer.time_s > bound_s && !told) {
        ++report.not_told;
        find(answer.time_s, fault.plan.device + " counts as well: " + name(fault));
      }
      if (told && !fault.has_noticed) {
        fault.has_noticed = true;
        row(fault).noticed_s.add(answer.time_s - fault.plan.begin_s);
      }
    }
    if (over && !fault.has_recovered && camera.image_s >= fault.plan.end_s && !camera.late && camera.state == "live") {
      recovered(fault, (camera.image_s - fault.plan.end_s) * input_.plan.image_rate_hz, answer.time_s);
    }
  }

  void recovered(Followed& fault, double periods, double time_s) {
    fault.has_recovered = true;
    FaultRow& of = row(fault);
    ++of.count;
    of.missed_s.add(periods);
    of.recovered_s.add(time_s - fault.plan.end_s);
  }

  const DayInput& input_;
  std::shared_ptr<const sensors::SimulatedCell> simulated_;
  RunningTruth truth_;
  std::vector<Followed> faults_;
  std::map<std::pair<bool, DeviceFault>, FaultRow> rows_;
  double first_s_ = 0;
  double last_s_ = 0;
  double exposure_s_ = kNaN;
};

void look_at_memory(std::istream& memory, DayReport& report) {
  std::vector<double> times_s;
  std::vector<double> mb;
  double time_s = 0;
  double kib = 0;
  while (memory >> time_s >> kib) {
    times_s.push_back(time_s);
    mb.push_back(kib / 1024);
  }
  constexpr std::size_t kLeast = 8;
  if (mb.size() < kLeast) {
    return;
  }
  report.has_memory = true;
  report.memory_mb = mb.back();
  const auto quarter = static_cast<std::ptrdiff_t>(mb.size() / 4);
  const auto median = [&](std::ptrdiff_t from, std::ptrdiff_t to) {
    std::vector<double> part(mb.begin() + from, mb.begin() + to);
    std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2), part.end());
    return part[part.size() / 2];
  };
  report.memory_growth_mb = median(3 * quarter, static_cast<std::ptrdiff_t>(mb.size())) - median(quarter, 2 * quarter);
  double n = 0;
  double t = 0;
  double y = 0;
  double tt = 0;
  double ty = 0;
  for (std::size_t i = static_cast<std::size_t>(quarter); i < mb.size(); ++i) {
    const double at = times_s[i] - times_s.front();
    n += 1;
    t += at;
    y += mb[i];
    tt += at * at;
    ty += at * mb[i];
  }
  constexpr double kHour_s = 3600;
  const double below = n * tt - t * t;
  report.memory_mb_per_hour = below > 0 ? kHour_s * (n * ty - t * y) / below : 0;
}

}  // namespace

std::vector<std::string> DayReport::failures() const {
  constexpr double kMostGrowth_mb = 4;
  std::vector<std::string> result;
  const auto none = [&](std::uint64_t count, const std::string& what) {
    if (count > 0) {
      result.push_back(std::to_string(count) + " " + what);
    }
  };
  if (answers == 0 || compared == 0) {
    result.emplace_back("there is no answer that could be compared");
  }
  none(over_estimates, "distances are more than the truth, by up to " + report::fixed(largest_excess_m, 4) + " m");
  none(not_stopped, "answers do not say stop though nothing is known");
  none(hidden_used, "answers stand on what a fault had made worthless");
  none(not_told, "answers do not tell a camera's fault within its bound");
  none(never_recovered, "times a device was not used again within 3 s");
  if (has_memory && memory_growth_mb > kMostGrowth_mb) {
    result.push_back("the memory grew by " + report::fixed(memory_growth_mb, 1) +
                     " MB from the second quarter to the last");
  }
  return result;
}

DayReport check_day(const DayInput& input, std::istream& answers, std::istream& memory) {
  Checking checking(input);
  std::string line;
  for (std::uint64_t n = 1; std::getline(answers, line); ++n) {
    if (answers.eof()) {  // the run was ended while it wrote
      break;
    }
    checking.take(seen(line, n, input.plan.begin_s, input));
  }
  checking.end();
  look_at_memory(memory, checking.report);
  return std::move(checking.report);
}

Json to_json(const DayReport& report) {
  const auto spread = [](const Samples& samples, double scale) {
    return Json{{"count", samples.count()},
                {"median", finite(scale * samples.median())},
                {"largest", finite(scale * samples.largest())}};
  };
  Json json;
  json["seconds"] = report.seconds;
  json["answers"] = report.answers;
  json["stopped"] = report.stopped;
  json["compared"] = report.compared;
  json["over_estimates"] = report.over_estimates;
  json["largest_excess_m"] = report.largest_excess_m;
  json["within_the_layer"] = report.unclaimed;
  json["truth_less_answer_m"] = spread(report.margin_m, 1);
  json["blind"] = report.blind;
  json["not_stopped"] = report.not_stopped;
  json["hidden_used"] = report.hidden_used;
  json["not_told"] = report.not_told;
  json["never_recovered"] = report.never_recovered;
  json["longest_gap_ms"] = 1e3 * report.longest_gap_s;
  json["latency_ms"] = spread(report.latency_s, 1e3);
  json["latency_ms"]["quantile_99_9"] = finite(1e3 * report.latency_s.quantile(0.999));
  json["memory_mb"] = report.memory_mb;
  json["memory_growth_mb"] = report.memory_growth_mb;
  json["memory_mb_per_hour"] = report.memory_mb_per_hour;
  json["faults"] = Json::array();
  for (const FaultRow& row : report.rows) {
    json["faults"].push_back({{"of", row.of},
                              {"fault", std::string(to_string(row.fault))},
                              {"count", row.count},
                              {"never_recovered", row.never_recovered},
                              {"noticed_ms", spread(row.noticed_s, 1e3)},
                              {"missed_periods", spread(row.missed_s, 1)},
                              {"recovered_ms", spread(row.recovered_s, 1e3)}});
  }
  json["failures"] = report.failures();
  json["findings"] = report.findings;
  return json;
}

std::string to_markdown(const DayReport& report) {
  const auto pair = [](const Samples& samples, double scale, int digits) {
    return samples.empty() ? std::string("- | -")
                           : report::fixed(scale * samples.median(), digits) + " | " +
                                 report::fixed(scale * samples.largest(), digits);
  };
  std::string text =
      "| of | fault | times | told after ms: median | largest | used again, in periods: median | largest | after ms: "
      "median | largest |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const FaultRow& row : report.rows) {
    text += "| " + row.of + " | " + std::string(to_string(row.fault)) + " | " + std::to_string(row.count) + " | " +
            pair(row.noticed_s, 1e3, 0) + " | " + pair(row.missed_s, 1, 2) + " | " + pair(row.recovered_s, 1e3, 0) +
            " |\n";
  }
  return text;
}

}  // namespace depthgrid::lab
