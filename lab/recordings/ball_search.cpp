#include "lab/recordings/ball_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "depthgrid/search/search.hpp"
#include "lab/recordings/ball_study.hpp"
#include "lab/recordings/cameras.hpp"
#include "lab/recordings/margin_settings.hpp"
#include "report/number_text.hpp"
#include "report/statistics.hpp"

namespace depthgrid::lab {

namespace {

constexpr double kRho_m = 0.5;
constexpr double kBallPlace_m = 0.02;

/// The same rig with the floor frame as its world, so that a box stands upright.
Rig on_floor(Rig rig) {
  const Pose T_floor_world = rig.T_floor_world.value_or(Pose::Identity());
  for (RigCamera& camera : rig.cameras) {
    camera.T_world_camera = T_floor_world * camera.T_world_camera;
  }
  rig.T_floor_world = Pose::Identity();
  return rig;
}

}  // namespace

Rig ball_rig(const files::Recording& recording) { return on_floor(with_kinect_range(recording.rig())); }

views::Settings ball_search_settings(std::vector<CameraMargins> margins, double v_max_m_s) {
  const Eigen::AlignedBox3d workspace = ball_workspace_floor();
  // The points lie up to 0.6 m around the ball.
  const Eigen::Vector3d around = Eigen::Vector3d::Constant(0.6);
  views::Settings settings;
  settings.space = views::BoxSpace{workspace.min() - around, workspace.max() + around};
  settings.policies = {views::Policy::ignored, views::Policy::ignored, views::Policy::obstacle, 0};
  settings.margins = std::move(margins);
  settings.rho_m = kRho_m;
  settings.v_max_m_s = v_max_m_s;
  return settings;
}

namespace {

views::Settings settings_of(const MarginSetting& setting, const CameraSet& cameras) {
  std::vector<CameraMargins> margins;
  for (const std::size_t k : cameras) {
    margins.push_back(setting.margins[k]);
  }
  return ball_search_settings(std::move(margins), setting.v_max_m_s);
}

bool covers(const RigCamera& camera, const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p_camera = camera.T_world_camera.inverse() * p_world;
  if (!(p_camera.z() > camera.rule.near_m)) {
    return false;
  }
  const DepthPoint p = project(camera.intrinsics, p_camera);
  return p.x_px >= 0 && p.y_px >= 0 && p.x_px < camera.intrinsics.width_px && p.y_px < camera.intrinsics.height_px;
}

/// A ball and how its own cameras see it, in the floor frame.
struct Ball {
  Eigen::Vector3d centre;
  double radius_m;
  std::vector<std::optional<BallFit>> fits;  ///< by camera of the set
};

/// The largest distance to the ball as one of the cameras alone fits it; -inf when none sees it.
double own_distance_m(const Ball& ball, const Eigen::Vector3d& p) {
  double most_m = -std::numeric_limits<double>::infinity();
  for (const auto& fit : ball.fits) {
    if (fit) {
      most_m = std::max(most_m, (p - fit->centre_world).norm() - fit->radius_m);
    }
  }
  return most_m;
}

std::size_t state_index(ProximityState state) {
  switch (state) {
    case ProximityState::measured:
      return 0;
    case ProximityState::occluded:
      return 1;
    case ProximityState::unmeasured:
      return 2;
    case ProximityState::beyond_rho:
      return 3;
    default:
      return 4;
  }
}

void take(BallSearchFigures& f, const Ball& ball, const Eigen::Vector3d& p, const Proximity& answer) {
  const double ball_m = (p - ball.centre).norm() - ball.radius_m;
  const double excess_m = answer.distance_m - ball_m;
  ++f.answers;
  ++f.states.at(state_index(answer.state));
  f.tested += ball_m + kTolerance_m < kRho_m ? 1 : 0;
  f.over += excess_m > 0 ? 1 : 0;
  f.over_5cm += excess_m > kTolerance_m ? 1 : 0;
  f.over_2cm += excess_m > kBallPlace_m ? 1 : 0;
  if (excess_m > 0) {
    const bool all_fit =
        std::all_of(ball.fits.begin(), ball.fits.end(), [](const auto& fit) { return fit.has_value(); });
    f.over_absent += all_fit ? 0 : 1;
    f.over_own += all_fit && answer.distance_m <= own_distance_m(ball, p) ? 1 : 0;
  }
  f.largest_m = f.answers == 1 ? excess_m : std::max(f.largest_m, excess_m);
  if ((answer.nearest_world - ball.centre).norm() <= kBallZone_m) {
    ++f.at_ball;
    f.errors_m.push_back(excess_m);
  }
}

/// Every choice of cameras once, in ascending order.
std::vector<CameraSet> all_sets(std::size_t camera_count) {
  std::vector<CameraSet> sets;
  for (std::size_t first = 0; first < camera_count; ++first) {
    for (const CameraSet& set : camera_sets(camera_count, first)) {
      if (std::is_sorted(set.begin(), set.end())) {
        sets.push_back(set);
      }
    }
  }
  return sets;
}

}  // namespace

std::vector<BallSearchFigures> study_ball_search(files::Recording& recording, const BallTrack& track,
                                                 const std::vector<int>& frames) {
  const Pose T_floor_world = recording.rig().T_floor_world.value_or(Pose::Identity());
  const Rig rig = ball_rig(recording);
  const std::size_t n = rig.cameras.size();
  std::vector<BallSearchFigures> rows;
  for (const MarginSetting& setting : ball_margins(rig)) {
    const std::size_t first_row = rows.size();
    for (std::size_t count = 1; count <= n; ++count) {
      rows.emplace_back();
      rows.back().setting = setting.name;
      rows.back().cameras = count;
    }
    for (const CameraSet& set : all_sets(n)) {
      const views::Settings settings = settings_of(setting, set);
      views::ViewStore store(sub_rig(rig, set), settings);
      search::Search search;
      for (const int frame : frames) {
        const auto tracked = track.centre_world.find(recording.frame_number(frame));
        if (tracked == track.centre_world.end()) {
          continue;
        }
        const auto images = recording.read(frame);
        Ball ball{T_floor_world * tracked->second, track.radius_m, {}};
        for (std::size_t slot = 0; slot < set.size(); ++slot) {
          (void)store.update(slot, images[set[slot]]);
          ball.fits.push_back(track.fit(tracked->first, rig.cameras[set[slot]].id));
          if (ball.fits.back()) {
            ball.fits.back()->centre_world = T_floor_world * ball.fits.back()->centre_world;
          }
        }
        const auto points = points_around(ball.centre);
        std::vector<Capsule> primitives;
        for (const auto& p : points) {
          primitives.push_back(Capsule::point(p));
        }
        std::vector<Answer> answers(points.size());
        search.distances(store.snapshot(), primitives, answers);
        for (std::size_t i = 0; i < points.size(); ++i) {
          const Eigen::Vector3d from_ball = points[i] - ball.centre;
          const Eigen::Vector3d on_ball = ball.centre + ball.radius_m * from_ball.normalized();
          const bool covered =
              std::any_of(set.begin(), set.end(), [&](std::size_t k) { return covers(rig.cameras[k], on_ball); });
          if (covered && from_ball.norm() > ball.radius_m && has_distance(answers[i].nearest)) {
            take(rows[first_row + set.size() - 1], ball, points[i], answers[i].nearest);
          }
        }
      }
    }
  }
  return rows;
}

std::string ball_search_tables(const std::vector<BallSearchFigures>& rows) {
  std::ostringstream out;
  out << "| margins | cameras | answers | at the ball | error, median | 5 % ... 95 % | can fail | D > ball | of these, "
         "a "
         "camera not in the track | the rest, a camera's own ball | by more than 2 cm | by more than 5 cm | largest D "
         "- "
         "ball |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const BallSearchFigures& f : rows) {
    const auto all = static_cast<double>(f.answers);
    out << "| " << f.setting << " | " << f.cameras << " | " << f.answers << " | "
        << report::percent_of(static_cast<double>(f.at_ball), all) << " | "
        << report::signed_millimetres(report::quantile(f.errors_m, 0.5)) << " mm | "
        << report::signed_millimetres(report::quantile(f.errors_m, 0.05)) << " ... "
        << report::signed_millimetres(report::quantile(f.errors_m, 0.95)) << " mm | " << f.tested << " | " << f.over
        << " | " << f.over_absent << " | " << f.over_own << " | " << f.over_2cm << " | " << f.over_5cm << " | "
        << report::signed_millimetres(f.largest_m) << " mm |\n";
  }
  out << "\n| margins | cameras | measured | occluded | unmeasured | nothing within rho | other |\n"
         "|---|---|---|---|---|---|---|\n";
  for (const BallSearchFigures& f : rows) {
    out << "| " << f.setting << " | " << f.cameras;
    for (const std::size_t count : f.states) {
      out << " | " << report::percent_of(static_cast<double>(count), static_cast<double>(f.answers));
    }
    out << " |\n";
  }
  return out.str();
}

}  // namespace depthgrid::lab
