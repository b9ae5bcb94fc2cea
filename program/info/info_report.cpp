#include "program/info/info_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <functional>

#include "program/info/calibration_report.hpp"
#include "report/statistics.hpp"

namespace depthgrid::program {

namespace {

// NOLINTBEGIN(cppcoreguidelines-pro-type-vararg, cert-dcl50-cpp): formats lay out tables, and the compiler checks them

constexpr std::size_t kPairsInTable = 30;

/// printf into a string; lines are short.
[[gnu::format(printf, 1, 2)]] std::string line(const char* format, ...) {
  std::array<char, 512> buffer{};
  va_list arguments;
  va_start(arguments, format);
  const int length = std::vsnprintf(buffer.data(), buffer.size(), format, arguments);
  va_end(arguments);
  return {buffer.data(), static_cast<std::size_t>(std::clamp(length, 0, static_cast<int>(buffer.size()) - 1))};
}

double percent(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

std::string cameras_text(const files::Recording& recording, const RecordingInfo& info) {
  std::string text = "camera            size        no measurement   depth range      margin m(D) it suggests\n";
  for (std::size_t k = 0; k < info.cameras.size(); ++k) {
    const auto& camera = recording.rig().cameras[k];
    const auto& survey = info.cameras[k];
    const SensorMargin margin = survey.noise.suggested_margin();
    text += line("%-17s %4d x %-4d %10.1f %%   %6.3f ... %-6.3f m   %.4f + %.5f D^2 m\n", camera.id.c_str(),
                 camera.intrinsics.width_px, camera.intrinsics.height_px,
                 percent(survey.invalid - survey.clamped, survey.pixels), static_cast<double>(survey.nearest_m),
                 static_cast<double>(survey.farthest_m), margin.constant_m, margin.quadratic_per_m);
    if (survey.clamped > 0) {
      text += line(
          "  %.1f %% of the pixels say \"farther than %g m\" (clamp_beyond_far): no surfaces, left out here and "
          "below\n",
          percent(survey.clamped, survey.pixels), camera.rule.far_m);
    }
  }
  return text;
}

/// What the rig file states; one line a camera.
std::string margins_text(const Rig& rig) {
  std::string text = "margins that the rig file states: m(D), filter radius; calibration; half exposure, time stamp\n";
  for (const RigCamera& camera : rig.cameras) {
    text += line("%-17s ", camera.id.c_str());
    if (!camera.margins) {
      text += "none\n";
      continue;
    }
    const CameraMargins& m = *camera.margins;
    text += line("%.4f + %.4f D + %.5f D^2 m, %d px; %.4f m, %.4f rad; %.1f ms, %.1f ms", m.sensor.constant_m,
                 m.sensor.linear, m.sensor.quadratic_per_m, m.sensor.lateral_px, m.translation_m, m.rotation_rad,
                 1e3 * m.half_exposure_s, 1e3 * m.time_uncertainty_s);
    text += camera.sensor.empty() ? "\n" : " (sensor " + camera.sensor + ")\n";
  }
  return text;
}

std::string pair_rows(const Rig& rig, const std::vector<const PairSurvey*>& pairs) {
  std::string text =
      "                              point to plane         along the ray\n"
      "pair                          median  < 50 mm    median  < 50 mm  in front  behind  overlap   intrusion 95 %\n";
  for (const auto* pair : pairs) {
    const auto& g = pair->agreement;
    text += line("%-28s %4.0f mm   %4.0f %%   %5.0f mm   %4.0f %%    %4.0f %%  %4.0f %%   %4.0f %%   %8.0f mm\n",
                 (rig.cameras[pair->a].id + " to " + rig.cameras[pair->b].id).c_str(),
                 1e3 * g.to_plane_m.quantile_m(0.5), percent(g.near_plane, g.planes),
                 1e3 * g.along_ray_m.quantile_m(0.5), percent(g.consistent, g.pairs), percent(g.in_front, g.pairs),
                 percent(g.behind, g.pairs), 100 * g.overlap(), 1e3 * suggested_pose_margin_m(g));
  }
  return text;
}

std::string pair_summary(const std::vector<const PairSurvey*>& pairs) {
  const auto row = [&](const char* name, const std::function<double(const PairAgreement&)>& figure, const char* unit) {
    std::vector<double> values;
    values.reserve(pairs.size());
    for (const auto* pair : pairs) {
      values.push_back(figure(pair->agreement));
    }
    return line("%-38s %6.1f %s   %6.1f ... %.1f %s\n", name, report::quantile(values, 0.5), unit,
                report::quantile(values, 0.1), report::quantile(values, 0.9), unit);
  };
  return line("over %zu pairs                           median      10 %% ... 90 %% of the pairs\n", pairs.size()) +
         row(
             "point to plane, median", [](const auto& g) { return 1e3 * g.to_plane_m.quantile_m(0.5); }, "mm") +
         row(
             "point to plane, within 50 mm", [](const auto& g) { return percent(g.near_plane, g.planes); }, "% ") +
         row(
             "along the ray, median", [](const auto& g) { return 1e3 * g.along_ray_m.quantile_m(0.5); }, "mm") +
         row(
             "along the ray, within 50 mm", [](const auto& g) { return percent(g.consistent, g.pairs); }, "% ") +
         row(
             "in front (< -100 mm)", [](const auto& g) { return percent(g.in_front, g.pairs); }, "% ") +
         row(
             "behind (> 100 mm)", [](const auto& g) { return percent(g.behind, g.pairs); }, "% ") +
         row(
             "intrusion, 95 % of the points below", [](const auto& g) { return 1e3 * suggested_pose_margin_m(g); },
             "mm");
}

std::string pair_name(const Rig& rig, const PairSurvey& pair) {
  return rig.cameras[pair.a].id + " to " + rig.cameras[pair.b].id;
}

std::string suggestion(const Rig& rig, const RecordingInfo& info, const std::vector<const PairSurvey*>& pairs) {
  SensorMargin margin;
  for (const auto& camera : info.cameras) {
    const SensorMargin own = camera.noise.suggested_margin();
    margin.constant_m = std::max(margin.constant_m, own.constant_m);
    margin.quadratic_per_m = std::max(margin.quadratic_per_m, own.quadratic_per_m);
  }
  double pose_m = 0;
  std::string apart;
  for (const auto* pair : pairs) {
    const double own_m = suggested_pose_margin_m(pair->agreement);
    pose_m = std::isnan(own_m) ? pose_m : std::max(pose_m, own_m);
    const PairAgreement& g = pair->agreement;
    if (g.planes > 0 && 2 * static_cast<std::int64_t>(g.intrusion_m.count()) < static_cast<std::int64_t>(g.planes)) {
      apart += "  ! " + pair_name(rig, *pair) +
               ": most surfaces that both see are not where the other has them: are the poses right?\n";
    }
  }
  const double up_m = std::ceil(pose_m * 1e3) * 1e-3;
  std::string text =
      "These figures suggest (no more than that: bias that all cameras share cannot be seen here)\n" +
      line("  --margin-constant %.4f --margin-quadratic %.5f", margin.constant_m, margin.quadratic_per_m);
  // No margin makes up for poses that are wrong.
  text += pairs.empty() || !apart.empty() ? "\n" : line(" --margin-translation %.3f\n", up_m);
  return text + apart;
}

}  // namespace

void CameraSurvey::add(const DepthImage& depth) {
  const std::size_t size = depth.index(0, depth.height_px());
  for (std::size_t i = 0; i < size; ++i) {
    const float z = depth.data()[i];
    if (!(z > 0.0F)) {
      ++invalid;
      continue;
    }
    nearest_m = nearest_m > 0.0F ? std::min(nearest_m, z) : z;
    farthest_m = std::max(farthest_m, z);
    depths.add(z);
  }
  pixels += static_cast<std::int64_t>(size);
  noise.add(depth);
}

void CameraSurvey::add_distorted(const DepthImage& depth, const std::vector<bool>& read) {
  for (std::size_t i = 0; i < read.size(); ++i) {
    const bool measured = depth.data()[i] > 0.0F;
    raw_invalid += measured ? 0 : 1;
    raw_cut += measured && !read[i] ? 1 : 0;
  }
  raw_pixels += static_cast<std::int64_t>(read.size());
}

std::string to_text(const files::Recording& recording, const RecordingInfo& info, const InfoLimits& limits) {
  const Rig& rig = recording.rig();
  std::string text = rig.name.empty() ? std::string("recording") : rig.name;
  text += line(": %zu camera%s, %d frame%s (%d to %d), %d looked at, ", rig.cameras.size(),
               rig.cameras.size() == 1 ? "" : "s", recording.frame_count(), recording.frame_count() == 1 ? "" : "s",
               recording.frame_number(0), recording.frame_number(recording.frame_count() - 1), info.frames_used);
  text += recording.rate_hz() ? line("%.4g a second\n", *recording.rate_hz()) : std::string("frame rate unknown\n");
  text += rig.T_floor_world ? "floor frame: known (--in floor)\n\n" : "floor frame: unknown\n\n";
  text += cameras_text(recording, info) + "\n";
  text += holes_text(rig, info.holes) + "\n";
  text += calibration_text(recording, info) + "\n";
  text += margins_text(rig) + "\n";

  std::vector<const PairSurvey*> pairs;
  for (const auto& pair : info.pairs) {
    if (pair.agreement.pairs > 0 && pair.agreement.overlap() >= limits.least_overlap) {
      pairs.push_back(&pair);
    }
  }
  if (pairs.empty()) {
    text += "agreement between cameras: there is no pair to compare\n\n";
  } else {
    text += line("agreement between cameras, points up to %g m\n", limits.limit_m);
    text += pairs.size() <= kPairsInTable || limits.all_pairs ? pair_rows(rig, pairs) : std::string();
    text += pairs.size() > kPairsInTable ? pair_summary(pairs) : std::string();
    text += "\n";
  }
  return text + suggestion(rig, info, pairs);
}

// NOLINTEND(cppcoreguidelines-pro-type-vararg, cert-dcl50-cpp)

}  // namespace depthgrid::program
