#include "lab/recordings/left_out_study.hpp"

#include <array>
#include <cmath>

#include "depthgrid/core/error.hpp"
#include "lab/measure/recording_folder.hpp"
#include "lab/recordings/ball_track.hpp"
#include "lab/recordings/cameras.hpp"

namespace depthgrid::lab {

namespace {

constexpr double kFar_m = 0.05;
constexpr double kFloor_m = 0.10;

DepthImage measured(const RigCamera& camera, const Frame& frame) {
  DepthImage image(camera.intrinsics.width_px, camera.intrinsics.height_px);
  normalise(frame.depth, camera.rule, image);
  return image;
}

Pose floor(const Rig& rig) { return rig.T_floor_world.value_or(Pose::Identity()); }

std::vector<CameraMargins> margins_of(const MarginSetting& setting, const CameraSet& cameras) {
  std::vector<CameraMargins> margins;
  for (const std::size_t k : cameras) {
    margins.push_back(setting.margins[k]);
  }
  return margins;
}

CameraSet all_but(std::size_t count, std::size_t left_out) {
  CameraSet others;
  for (std::size_t k = 0; k < count; ++k) {
    if (k != left_out) {
      others.push_back(k);
    }
  }
  return others;
}

/// Takes the images of all cameras but one, at the poses of the rig.
void update(LeaveOneOut& others, const Rig& rig, const CameraSet& cameras, std::span<const Frame> frames) {
  for (std::size_t slot = 0; slot < cameras.size(); ++slot) {
    others.update(slot, frames[cameras[slot]], rig.cameras[cameras[slot]].T_world_camera);
  }
}

/// Four slots of the kitchen's camera. The poses come with the images.
Rig moving_camera(const Rig& rig, std::size_t slots) {
  Rig moving;
  for (std::size_t slot = 0; slot < slots; ++slot) {
    moving.cameras.push_back(rig.cameras.front());
    moving.cameras.back().id = "slot" + std::to_string(slot);
    moving.cameras.back().T_world_camera = Pose::Identity();
  }
  return moving;
}

void check_sequence(const Rig& rig, std::span<const Frame> frames, const MarginSetting& setting, std::size_t slots,
                    int stride, LeftOutFigures& figures) {
  LeaveOneOut others(moving_camera(rig, slots), setting.margins, setting.v_max_m_s);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const RigCamera& camera = rig.cameras[i];
    if (i >= slots) {
      check_left_out(others, {camera, setting.margins.front(), measured(camera, frames[i]), {}, floor(rig)}, stride,
                     figures, nullptr);
    }
    others.update(i % slots, frames[i], camera.T_world_camera);
  }
}

}  // namespace

void check_left_out(LeaveOneOut& others, const LeftOutImage& image, int stride, LeftOutFigures& figures,
                    std::vector<MarkedReading>* marked) {
  std::vector<DepthImage> freeing;
  for (std::size_t slot = 0; slot < others.camera_count(); ++slot) {
    freeing.push_back(others.measured(slot));
  }
  for (const LeftOutReading& reading : others.check(image.camera, image.margins, image.depth, stride)) {
    ++figures.readings;
    figures.edge_readings += at_edge(image.depth, reading.u, reading.v) ? 1 : 0;
    figures.free_before += reading.before_m > 0 ? 1 : 0;
    if (!reading.violates()) {
      continue;
    }
    if (reading.known_free_by < 0) {
      fail("a point that no camera frees has the distance ", reading.answer_m, " m; it is an obstacle, so must have 0");
    }
    const auto slot = static_cast<std::size_t>(reading.known_free_by);
    const LeftOutCause cause = cause_of(reading, image.depth, image.median, freeing[slot]);
    ++figures.violations;
    ++figures.causes.at(static_cast<std::size_t>(cause));
    ++figures.known_free_by[others.id(slot)];
    figures.on_floor += std::abs((image.T_floor_world * reading.p_world).z()) < kFloor_m ? 1 : 0;
    figures.excesses_m.push_back(reading.answer_m - reading.allowance_m);
    figures.far_violations += figures.excesses_m.back() > kFar_m ? 1 : 0;
    if (marked != nullptr) {
      marked->push_back({reading, cause});
    }
  }
}

std::vector<LeftOutRow> ball_leave_one_out(files::Recording& recording, const std::vector<int>& frames, int stride) {
  const Rig rig = with_kinect_range(recording.rig());
  const std::size_t n = rig.cameras.size();
  std::vector<std::vector<DepthImage>> images(n);
  for (const int frame : frames) {
    const auto taken = recording.read(frame);
    for (std::size_t k = 0; k < n; ++k) {
      images[k].push_back(measured(rig.cameras[k], taken[k]));
    }
  }
  std::vector<DepthImage> medians;
  for (std::size_t k = 0; k < n; ++k) {
    medians.push_back(median_image(images[k]));
  }
  std::vector<LeftOutRow> rows;
  for (const MarginSetting& setting : ball_margins(rig)) {
    for (std::size_t k = 0; k < n; ++k) {
      const CameraSet cameras = all_but(n, k);
      LeaveOneOut others(sub_rig(rig, cameras), margins_of(setting, cameras), setting.v_max_m_s);
      LeftOutRow row{setting.name, rig.cameras[k].id, {}};
      for (std::size_t i = 0; i < frames.size(); ++i) {
        update(others, rig, cameras, recording.read(frames[i]));
        check_left_out(others, {rig.cameras[k], setting.margins[k], images[k][i], medians[k], floor(rig)}, stride,
                       row.figures, nullptr);
      }
      rows.push_back(row);
    }
  }
  return rows;
}

std::vector<LeftOutRow> kitchen_leave_one_out(int stride) {
  constexpr std::size_t kSlots = 4;
  files::Recording recording(recording_folder("redkitchen_poses"));
  const Rig rig = with_kinect_range(recording.rig());
  const auto frames = recording.read(0);
  const std::array<std::array<const char*, 4>, 3> suggested = {{{"f000000", "f000160", "f000480", "f000580"},
                                                                {"f000220", "f000320", "f000460", "f000800"},
                                                                {"f000240", "f000360", "f000520", "f000880"}}};
  std::vector<LeftOutRow> rows;
  for (const MarginSetting& setting : kitchen_margins(kSlots)) {
    LeftOutRow row{setting.name, "next of a moving camera", {}};
    check_sequence(rig, frames, setting, kSlots, stride, row.figures);
    rows.push_back(row);
  }
  for (const MarginSetting& setting : kitchen_margins(kSlots - 1)) {
    LeftOutRow row{setting.name, "each of four far apart", {}};
    for (const auto& ids : suggested) {
      for (std::size_t left_out = 0; left_out < ids.size(); ++left_out) {
        LeaveOneOut others(moving_camera(rig, kSlots - 1), setting.margins, setting.v_max_m_s);
        std::size_t slot = 0;
        for (std::size_t i = 0; i < ids.size(); ++i) {
          const std::size_t k = camera_index(rig, ids.at(i));
          if (i != left_out) {
            others.update(slot++, frames[k], rig.cameras[k].T_world_camera);
          }
        }
        const std::size_t k = camera_index(rig, ids.at(left_out));
        const DepthImage depth = measured(rig.cameras[k], frames[k]);
        check_left_out(others, {rig.cameras[k], setting.margins.front(), depth, {}, floor(rig)}, stride, row.figures,
                       nullptr);
      }
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace depthgrid::lab
