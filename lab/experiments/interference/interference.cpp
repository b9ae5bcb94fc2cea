#include "lab/experiments/interference/interference.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "lab/experiments/experiment_report.hpp"
#include "lab/experiments/stage/comparison_picture.hpp"
#include "lab/experiments/stage/instant_groups.hpp"
#include "lab/experiments/stage/method_comparison.hpp"
#include "lab/experiments/stage/rig_width.hpp"
#include "report/markdown_table.hpp"
#include "report/number_text.hpp"

namespace depthgrid::experiments {

namespace {

using simulation::Motion;

// Places in interference_candidates().
constexpr std::size_t kLetter = 0;
constexpr std::size_t kSearchCandidate = 2;
constexpr std::size_t kMemoryCandidate = 3;  ///< where a sensor is given

/// The robot's pixels count as background, so that its own shadows do not cover what the noise does.
std::vector<Candidate> interference_candidates(const Options& options) {
  constexpr auto kBackground = RobotPixels::background;
  std::vector<Candidate> all{{"letter", EvaluationMethod::letter, {0, 1}, kBackground},
                             {"corrected", EvaluationMethod::corrected, {0, 1}, kBackground},
                             {"search", EvaluationMethod::search, {0, 1}, kBackground}};
  if (options.sensor) {
    all.push_back({"search with memory", EvaluationMethod::search_memory, {0, 1}, kBackground});
  }
  return all;
}

struct Setting {
  const char* label;
  const char* title;  ///< of the first camera's image
  bool disturbed;
  bool vibrating;
};
constexpr std::array<Setting, 3> kSettings{{
    {"each alone", "camera 1 alone", false, false},
    {"both", "camera 1, camera 2 beside it", true, false},
    {"both, the second vibrates", "camera 1, camera 2 vibrates", true, true},
}};

simulation::SensorGroupSettings noise(const Setting& setting, std::uint64_t seed) {
  simulation::SensorGroupSettings settings;
  settings.seed = seed;
  settings.vibrating = {false, setting.vibrating};
  if (!setting.disturbed) {
    settings.interference.lost_share = 0;
    settings.interference.lost_share_vibrating = 0;
  }
  return settings;
}

/// Adds an image to the means over `frames` images.
void count_pixels(const CameraImages& images, std::size_t camera, int frames, InterferenceCase& result) {
  const DepthImage& image = images.depth_m(camera);
  const auto pixels = static_cast<std::ptrdiff_t>(image.index(0, image.height_px()));
  FreeDepth free(image.width_px(), image.height_px(), images.rig().cameras[camera].margins->sensor);
  free.update(image, {});
  const auto share = [&](const DepthImage& of) {
    return static_cast<double>(std::count(of.data(), of.data() + pixels, 0.0F)) / static_cast<double>(pixels);
  };
  result.invalid_share[camera] += share(image) / frames;
  result.blocked_share[camera] += share(free.image()) / frames;
}

/// What one state of the two Kinects gives, for figures and for the picture.
struct CaseRun {
  InterferenceCase figures;
  std::vector<Instant> instants;
  DepthImage shown;  ///< of the first camera, in the middle of the motion
};

/// Adds the last instant of a run.
void count_answers(CaseRun& run, int frames) {
  const Instant& instant = run.instants.back();
  add_answers(instant, run.figures.methods);
  const auto& answers = instant.answers[kSearchCandidate];
  const auto unmeasured = std::count_if(answers.begin(), answers.end(), [](const Proximity& answer) {
    return answer.state == ProximityState::unmeasured;
  });
  run.figures.unmeasured_share +=
      static_cast<double>(unmeasured) / (static_cast<double>(answers.size()) * static_cast<double>(frames));
}

CaseRun run_case(const Setting& setting, const simulation::Arrangement& arrangement, const Rig& rig, int frames,
                 const Options& options, const std::function<void(int)>& done) {
  StagedCell stage(Motion::reach, stage_around_the_wrist(), options.seed);
  MethodComparison comparison(stage, rig, arrangement, interference_candidates(options), noise(setting, options.seed));
  const auto time_of = [&](int frame) { return stage.person().duration_s() * (frame + 0.5) / frames; };
  FramesBetween between(stage, comparison, &StagedCell::move_to, time_of(0));
  CaseRun run;
  run.figures.label = setting.label;
  run.figures.methods = empty_rows(comparison.candidates());
  for (int frame = 0; frame < frames; ++frame) {
    const double time_s = time_of(frame);
    between.play_until(time_s);
    stage.move_to(time_s);
    run.instants.push_back(comparison.at(stage, time_s, static_cast<std::uint64_t>(frame)));
    const CameraImages& images = comparison.images(RobotPixels::background);
    for (std::size_t camera = 0; camera < 2; ++camera) {
      count_pixels(images, camera, frames, run.figures);
    }
    count_answers(run, frames);
    if (frame == frames / 2) {
      run.shown = images.depth_m(0);
    }
    done(frame + 1);
  }
  return run;
}

report::Canvas draw(const std::vector<CaseRun>& runs, const RigCamera& camera) {
  std::vector<AnswerTile> tiles;
  report::Plot letter{"letter: median distance of the nine points, both cameras", "time (s)", "m", false, false, {}};
  report::Plot search{"search: the same", "time (s)", "m", false, false, {}};
  report::Plot memory{"search with memory: the same", "time (s)", "m", false, false, {}};
  letter.series.push_back(median_truth(runs.front().instants, DistanceMethod::kRho));
  search.series.push_back(letter.series.front());
  memory.series.push_back(letter.series.front());
  const bool remembers = runs.front().figures.methods.size() > kMemoryCandidate;
  for (std::size_t s = 0; s < runs.size(); ++s) {
    const InterferenceCase& figures = runs[s].figures;
    tiles.push_back({std::string(kSettings[s].title) + ": " + report::percent(figures.invalid_share[0]) + " invalid",
                     &camera, &runs[s].shown, nullptr, nullptr});
    letter.series.push_back(median_answers(runs[s].instants, kLetter, figures.label));
    search.series.push_back(median_answers(runs[s].instants, kSearchCandidate, figures.label));
    if (remembers) {
      memory.series.push_back(median_answers(runs[s].instants, kMemoryCandidate, figures.label));
    }
  }
  return draw_comparison(
      tiles, remembers ? std::vector<report::Plot>{letter, search, memory} : std::vector<report::Plot>{letter, search});
}

}  // namespace

std::vector<InterferenceCase> measure_interference(const Options& options, ExperimentReport* pictures) {
  simulation::Arrangement arrangement = simulation::arrangement(8, sensor_or(options, "kinect_v1"));
  arrangement.rig.cameras.resize(2);  // neighbours: the others do not light this space
  const Rig rig = with_width(arrangement.rig, width_or(options, 640, 320));
  const int frames = frames_or(options, 30, 8);
  std::vector<CaseRun> runs;
  for (const Setting& setting : kSettings) {
    const std::size_t before = runs.size();
    runs.push_back(run_case(setting, arrangement, rig, frames, options, [&](int done) {
      options.progress(before * static_cast<std::size_t>(frames) + static_cast<std::size_t>(done),
                       kSettings.size() * static_cast<std::size_t>(frames));
    }));
  }
  if (pictures != nullptr) {
    pictures->picture(
        "interference.png", draw(runs, rig.cameras.front()),
        "Above: one instant as camera 1 measures it; turquoise: no measurement; shares are means over the "
        "motion. Robot pixels are replaced by the room. Below: what the methods make of it.");
  }
  std::vector<InterferenceCase> cases;
  cases.reserve(runs.size());
  for (CaseRun& run : runs) {
    cases.push_back(std::move(run.figures));
  }
  return cases;
}

void run_interference(const Options& options, ExperimentReport& report) {
  report.paragraph(
      "Two cameras (" + std::string(sensor_or(options, "kinect_v1")) +
      "), 45 degrees apart around the robot, look at a person who reaches for it, as in Fig. 14 of the "
      "letter. **What is lost is assumed, not found**: of the pixels that the other Kinect lights too 3.57 % in spots "
      "of 5 pixels, 0.28 % when one of the two vibrates (after Maimone and Fuchs, VR 2012). Cameras that face each "
      "other light few surfaces in common and would show little of it.");
  const std::vector<InterferenceCase> cases = measure_interference(options, &report);
  report.headline("Without measurement in the first camera's images: " + report::percent(cases[0].invalid_share[0]) +
                  " of the pixels alone, " + report::percent(cases[1].invalid_share[0]) +
                  " with a second Kinect beside it, " + report::percent(cases[2].invalid_share[0]) +
                  " when that one vibrates (the model's assumption).");
  const auto medians = [&](std::size_t method) {
    std::string text;
    for (std::size_t c = 0; c < cases.size(); ++c) {
      text += (c == 0   ? ""
               : c == 1 ? ", "
                        : " and ") +
              report::fixed(1000 * cases[c].methods[method].deviation.shortfall_m(0.5));
    }
    return text + " mm";
  };
  report.headline("Half of the letter's distances then are more than " + medians(kLetter) +
                  " too near, half of the search's more than " + medians(kSearchCandidate) +
                  (options.sensor ? ", of the search's with memory more than " + medians(kMemoryCandidate) : "") + ".");
  report::MarkdownTable table({"Kinects", "without measurement, camera 1", "camera 2",
                               "free nothing with the lateral margin, camera 1", "camera 2",
                               "nearest for the search: an unmeasured pixel's ray"});
  for (const InterferenceCase& c : cases) {
    table.row({c.label, report::percent(c.invalid_share[0]), report::percent(c.invalid_share[1]),
               report::percent(c.blocked_share[0]), report::percent(c.blocked_share[1]),
               report::percent(c.unmeasured_share)});
    auto& json = report.figures()[c.label];
    json["invalid_share"] = c.invalid_share;
    json["free_nothing_share"] = c.blocked_share;
    json["search_nearest_unmeasured_share"] = c.unmeasured_share;
    json["distances"] = deviation_figures(c.methods);
  }
  report.paragraph(table.text());
  report.paragraph(
      "Distances with both cameras from nine points of the arm, up to 0.4 m, beside the real ones. The robot's pixels "
      "count as background, so that its own shadows do not cover what the noise does.");
  for (const InterferenceCase& c : cases) {
    report.paragraph(c.label + ":");
    report.paragraph(deviation_table(c.methods));
  }
}

}  // namespace depthgrid::experiments
