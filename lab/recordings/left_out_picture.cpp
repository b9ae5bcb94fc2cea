#include <array>

#include "lab/recordings/cameras.hpp"
#include "lab/recordings/left_out_study.hpp"
#include "report/canvas.hpp"
#include "report/depth_picture.hpp"

namespace depthgrid::lab {

namespace {

constexpr int kWidth_px = 480;
constexpr int kHeight_px = 360;
constexpr int kGap_px = 8;
constexpr int kHead_px = 34;
constexpr int kCaption_px = 24;
constexpr int kFoot_px = 40;
constexpr int kStride = 2;
constexpr std::array<report::Colour, kLeftOutCauses> kColours = {
    {{0.10, 0.35, 1.00}, {0.10, 0.75, 0.15}, {0.75, 1.00, 0.20}, {1.00, 0.05, 0.05}, {1.00, 1.00, 1.00}}};

DepthImage read_measured(files::Recording& recording, const Rig& rig, std::size_t camera, int frame) {
  DepthImage image(rig.cameras[camera].intrinsics.width_px, rig.cameras[camera].intrinsics.height_px);
  normalise(recording.read(frame)[camera].depth, rig.cameras[camera].rule, image);
  return image;
}

void draw_legend(report::Canvas& canvas, double y_px) {
  double x_px = kGap_px + 250;
  for (std::size_t i = 0; i < kLeftOutCauses; ++i) {
    const std::string name(to_string(static_cast<LeftOutCause>(i)));
    canvas.fill({x_px, y_px, 11, 11}, kColours.at(i));
    canvas.outline({x_px, y_px, 11, 11}, {report::kBlack, 1});
    canvas.text({x_px + 16, y_px + 10}, name, 12);
    x_px += 40 + canvas.text_width_px(name, 12);
  }
}

}  // namespace

void save_left_out_picture(const std::filesystem::path& file, files::Recording& recording,
                           const std::vector<int>& frames, int frame) {
  const Rig rig = with_kinect_range(recording.rig());
  const std::size_t n = rig.cameras.size();
  const auto settings = ball_margins(rig);
  const std::array<const MarginSetting*, 2> shown = {&settings.at(1), &settings.at(2)};
  report::Canvas canvas(static_cast<int>(n) * (kWidth_px + kGap_px) + kGap_px,
                        kHead_px + 2 * (kHeight_px + kCaption_px) + kFoot_px);
  canvas.text({kGap_px, 23},
              "kinect3_ball, frame " + std::to_string(recording.frame_number(frame)) +
                  ": readings that lie in space that the other two cameras report free by more than allowed",
              16);
  const report::DepthRange range{0.5, 5.0};
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<DepthImage> images;
    for (const int index : frames) {
      images.push_back(read_measured(recording, rig, k, index));
    }
    const DepthImage median = median_image(images);
    const DepthImage depth = read_measured(recording, rig, k, frame);
    for (std::size_t row = 0; row < shown.size(); ++row) {
      const MarginSetting& setting = *shown.at(row);
      CameraSet others;
      std::vector<CameraMargins> margins;
      for (std::size_t i = 0; i < n; ++i) {
        if (i != k) {
          others.push_back(i);
          margins.push_back(setting.margins[i]);
        }
      }
      LeaveOneOut search(sub_rig(rig, others), margins, setting.v_max_m_s);
      const auto taken = recording.read(frame);
      for (std::size_t slot = 0; slot < others.size(); ++slot) {
        search.update(slot, taken[others[slot]], rig.cameras[others[slot]].T_world_camera);
      }
      LeftOutFigures figures;
      std::vector<MarkedReading> marked;
      check_left_out(search, {rig.cameras[k], setting.margins[k], depth, median, Pose::Identity()}, kStride, figures,
                     &marked);
      const report::Rectangle tile{
          static_cast<double>(kGap_px) + static_cast<double>(k) * (kWidth_px + kGap_px),
          static_cast<double>(kHead_px) + static_cast<double>(row) * (kHeight_px + kCaption_px), kWidth_px, kHeight_px};
      report::draw_depth(canvas, tile, depth, range);
      const double scale = tile.width_px / depth.width_px();
      // Few marks would be lost among the image's own colours.
      const bool few = marked.size() < 200;
      for (const MarkedReading& mark : marked) {
        if (few) {
          const report::CanvasPoint at{tile.x_px + scale * (mark.reading.u + 0.5),
                                       tile.y_px + scale * (mark.reading.v + 0.5)};
          canvas.disc(at, 4.0, report::kBlack);
          canvas.disc(at, 3.0, kColours.at(static_cast<std::size_t>(mark.cause)));
          continue;
        }
        canvas.fill({tile.x_px + scale * (mark.reading.u - 0.5), tile.y_px + scale * (mark.reading.v - 0.5),
                     kStride * scale, kStride * scale},
                    kColours.at(static_cast<std::size_t>(mark.cause)));
      }
      canvas.text({tile.x_px, tile.y_px + kHeight_px + 16},
                  rig.cameras[k].id + " left out, margins: " + setting.name + ": " +
                      std::to_string(figures.violations) + " of " + std::to_string(figures.readings),
                  13);
    }
  }
  const double foot_px = canvas.height_px() - kFoot_px + 6;
  report::draw_depth_legend(canvas, {static_cast<double>(kGap_px), foot_px, 190, 10}, range);
  draw_legend(canvas, foot_px);
  canvas.save_png(file);
}

}  // namespace depthgrid::lab
