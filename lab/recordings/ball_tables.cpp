#include "lab/recordings/ball_tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "report/number_text.hpp"
#include "report/statistics.hpp"

namespace depthgrid::lab {

namespace {

bool is_shadow(const Sample& sample) {
  return sample.state == ProximityState::occluded || sample.state == ProximityState::unmeasured ||
         sample.state == ProximityState::unobserved;
}

bool counts(const Sample& sample) { return sample.inside && sample.ball_distance_m > 0; }

std::string names(const Rig& rig, const CameraSet& set, std::size_t from) {
  std::string text;
  for (std::size_t i = from; i < set.size(); ++i) {
    text += (text.empty() ? "" : " + ") + rig.cameras[set[i]].id;
  }
  return text;
}

double milliseconds_per_answer(const SettingResult& result, std::size_t camera_count) {
  double seconds = 0;
  double answers = 0;
  for (const auto& set : result.sets) {
    if (set.cameras.size() == camera_count) {
      seconds += set.seconds;
      answers += static_cast<double>(set.samples.size());
    }
  }
  return 1e3 * seconds / answers;
}

void error_table(const BallStudy& study, std::size_t most, std::ostream& out) {
  out << "| setting | cameras | answers | at the ball | error, median | 5 % ... 95 % | largest | elsewhere, can fail | "
         "D > ball + 5 cm | of these, ball unseen | worst D - ball | ms a point |\n"
         "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& result : study.settings) {
    for (std::size_t n = 1; n <= most; ++n) {
      const BallFigures f = ball_figures(result, n);
      out << "| " << result.setting.name << " | " << n << " | " << f.answers << " | "
          << report::percent_of(static_cast<double>(f.at_ball), static_cast<double>(f.answers)) << " | "
          << report::signed_millimetres(f.error_median_m) << " mm | " << report::signed_millimetres(f.error_5_m)
          << " ... " << report::signed_millimetres(f.error_95_m) << " mm | "
          << report::signed_millimetres(f.error_largest_m) << " mm | " << f.tested << " | " << f.violations << " ("
          << report::percent_of(static_cast<double>(f.violations), static_cast<double>(f.tested)) << ") | "
          << f.violations_unseen << " | "
          << (f.violations > 0 ? report::signed_millimetres(f.worst_excess_m) + " mm" : std::string("-")) << " | "
          << report::fixed(milliseconds_per_answer(result, n), 2) << " |\n";
    }
  }
}

void shadow_table(const BallStudy& study, const Rig& rig, std::ostream& out) {
  out << "| setting | principal | points | shadow obstacle with one camera | at a pixel without measurement | with "
         "three | with one, none with three | "
         "then measured | then nothing within rho |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& result : study.settings) {
    for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
      const ShadowFigures f = shadow_figures(result, k);
      const auto all = static_cast<double>(f.points);
      out << "| " << result.setting.name << " | " << rig.cameras[k].id << " | " << f.points << " | " << f.shadow_one
          << " (" << report::percent_of(static_cast<double>(f.shadow_one), all) << ") | "
          << report::percent_of(static_cast<double>(f.unmeasured), static_cast<double>(f.shadow_one)) << " of them | "
          << f.shadow_all << " (" << report::percent_of(static_cast<double>(f.shadow_all), all) << ") | "
          << f.one_not_all << " ("
          << report::percent_of(static_cast<double>(f.one_not_all), static_cast<double>(f.shadow_one)) << " of them) | "
          << f.now_measured << " | " << f.now_none << " |\n";
    }
  }
}

}  // namespace

BallFigures ball_figures(const SettingResult& result, std::size_t camera_count) {
  BallFigures f;
  std::vector<double> errors;
  f.worst_excess_m = std::numeric_limits<double>::quiet_NaN();
  f.error_largest_m = std::numeric_limits<double>::quiet_NaN();
  const double rho_m = result.setting.evaluation.rho_m;
  for (const auto& set : result.sets) {
    if (set.cameras.size() != camera_count) {
      continue;
    }
    for (const Sample& sample : set.samples) {
      if (!counts(sample) || std::isnan(sample.distance_m)) {
        continue;
      }
      ++f.answers;
      const double excess_m = static_cast<double>(sample.distance_m) - static_cast<double>(sample.ball_distance_m);
      if (sample.at_ball) {
        ++f.at_ball;
        errors.push_back(excess_m);
        if (!(std::abs(excess_m) <= std::abs(f.error_largest_m))) {
          f.error_largest_m = excess_m;
        }
        continue;
      }
      ++f.elsewhere;
      f.tested += static_cast<double>(sample.ball_distance_m) + kTolerance_m < rho_m ? 1 : 0;
      if (excess_m > kTolerance_m) {
        ++f.violations;
        f.violations_unseen += sample.ball_seen ? 0 : 1;
        f.worst_excess_m = f.worst_excess_m > excess_m ? f.worst_excess_m : excess_m;
      }
    }
  }
  f.error_median_m = report::quantile(errors, 0.5);
  f.error_5_m = report::quantile(errors, 0.05);
  f.error_95_m = report::quantile(errors, 0.95);
  return f;
}

ShadowFigures shadow_figures(const SettingResult& result, std::size_t principal) {
  const std::vector<Sample>* one = nullptr;
  const std::vector<Sample>* all = nullptr;
  std::size_t most = 0;
  for (const auto& set : result.sets) {
    if (set.cameras.front() == principal) {
      one = set.cameras.size() == 1 ? &set.samples : one;
      all = set.cameras.size() > most ? &set.samples : all;
      most = std::max(most, set.cameras.size());
    }
  }
  ShadowFigures f;
  for (std::size_t i = 0; one != nullptr && i < one->size(); ++i) {
    if (one->at(i).state == ProximityState::outside) {
      continue;
    }
    ++f.points;
    const bool shadow_one = is_shadow(one->at(i));
    const bool shadow_all = is_shadow(all->at(i));
    f.shadow_one += shadow_one ? 1 : 0;
    f.unmeasured += one->at(i).state == ProximityState::unmeasured ? 1 : 0;
    f.shadow_all += shadow_all ? 1 : 0;
    if (shadow_one && !shadow_all) {
      ++f.one_not_all;
      f.now_measured += all->at(i).state == ProximityState::measured ? 1 : 0;
      f.now_none += all->at(i).state == ProximityState::beyond_rho ? 1 : 0;
    }
  }
  return f;
}

std::string ball_tables(const BallStudy& study, const Rig& rig) {
  std::ostringstream out;
  error_table(study, rig.cameras.size(), out);
  out << "\n### Gray area\n\n"
         "| principal | others | grid in the workspace | gray | known free, letter's test | known free, whole cell "
         "seen free |\n"
         "|---|---|---|---|---|---|\n";
  for (const auto& [set, area] : study.gray) {
    const auto frames = static_cast<double>(study.frames);
    out << "| " << rig.cameras[set.front()].id << " | " << names(rig, set, 1) << " | "
        << report::fixed(area.workspace_m3 / frames, 2) << " m^3 | "
        << report::percent_of(area.gray_m3, area.workspace_m3) << " | "
        << report::percent_of(area.known_free_letter_m3, area.gray_m3) << " | "
        << report::percent_of(area.known_free_corrected_m3, area.gray_m3) << " |\n";
  }
  out << "\n### Shadow obstacles\n\n";
  shadow_table(study, rig, out);
  return out.str();
}

}  // namespace depthgrid::lab
