// The bystander's view of the film: surfaces where they are, haze only before what stands behind it.
#include "lab/experiments/film/cell_view.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "report/scene_colours.hpp"

namespace depthgrid::experiments {
namespace {

using Eigen::Vector3d;

/// A ball of the person's colour at the origin, seen from x = 2.
simulation::Workcell ball_cell() {
  simulation::Workcell cell;
  simulation::WorkcellBody body;
  body.name = "ball";
  body.kind = simulation::BodyKind::person;
  body.spheres = {{Vector3d::Zero(), 0.3}};
  cell.bodies = {body};
  return cell;
}

std::array<int, 3> pixel(const report::Raster& raster, const report::CanvasPoint& at) {
  const auto first = 3 * (static_cast<std::size_t>(at.y_px) * static_cast<std::size_t>(raster.width_px) +
                          static_cast<std::size_t>(at.x_px));
  return {raster.rgb[first], raster.rgb[first + 1], raster.rgb[first + 2]};
}

TEST(UnknownCubes, AskForThePlaceThatTheyWereFilledAt) {
  UnknownCubes cubes(Vector3d(-0.2, 0.1, 1), Vector3d(0.1, 0.3, 1.4), 0.1);
  EXPECT_EQ(cubes.count, (std::array<int, 3>{3, 2, 4}));
  for (std::size_t i = 0; i < cubes.unknown.size(); ++i) {
    cubes.unknown[i] = 1;
    for (std::size_t j = 0; j < cubes.unknown.size(); ++j) {
      EXPECT_EQ(cubes.contains_unknown(cubes.centre_world(j)), i == j);
    }
    cubes.unknown[i] = 0;
  }
  cubes.unknown.assign(cubes.unknown.size(), 1);
  EXPECT_FALSE(cubes.contains_unknown(Vector3d(-0.21, 0.15, 1.2)));
  EXPECT_FALSE(cubes.contains_unknown(Vector3d(0, 0.15, 1.41)));
}

TEST(CellView, HazeCoversWhatIsBehindItAndNothingElse) {
  const simulation::Workcell cell = ball_cell();
  CellView view(cell, Vector3d(2, 0, 0), Vector3d::Zero(), 64, 48);
  UnknownCubes haze(Vector3d(0.5, -0.5, -0.5), Vector3d(1.5, 0.5, 0.5), 0.1);
  const report::CanvasPoint middle = view.at(Vector3d(0.3, 0.001, 0.001));
  EXPECT_NEAR(middle.x_px, 32, 0.5);
  EXPECT_LT(view.at(Vector3d(0, 0, 0.2)).y_px, 24) << "upwards is up";
  const std::array<int, 3> clear = pixel(view.draw(cell, haze), middle);
  EXPECT_GT(clear[0], clear[2] + 80) << "the ball, lit from the front";
  haze.unknown.assign(haze.unknown.size(), 1);
  const std::array<int, 3> hidden = pixel(view.draw(cell, haze), middle);
  // A metre of it lets exp(-2.6) through.
  const double share = std::exp(-2.6);
  EXPECT_NEAR(hidden[0], share * clear[0] + (1 - share) * 255 * report::kGrayArea.red, 2);
  UnknownCubes behind(Vector3d(-1.5, -0.5, -0.5), Vector3d(-0.5, 0.5, 0.5), 0.1);
  behind.unknown.assign(behind.unknown.size(), 1);
  EXPECT_EQ(pixel(view.draw(cell, behind), middle), clear);
}

}  // namespace
}  // namespace depthgrid::experiments
