// Depth images with the answers of several candidates in them, and how the smallest distance went over time.
#pragma once

#include <string>
#include <vector>

#include "lab/experiments/stage/method_comparison.hpp"
#include "report/canvas.hpp"
#include "report/plot.hpp"

namespace depthgrid::experiments {

/// One image of a row: what a camera sees, and in it the answers of a candidate.
struct AnswerTile {
  std::string title;
  const RigCamera* camera = nullptr;
  const DepthImage* depth_m = nullptr;
  const Instant* instant = nullptr;
  const std::vector<Proximity>* answers = nullptr;  ///< one a point of the instant; null: none is drawn
};

/// What a camera of `images` sees now, which is the time of `instant`, and one candidate's answers then. Both must
/// outlive the tile.
[[nodiscard]] AnswerTile answer_tile(std::string title, const CameraImages& images, std::size_t camera,
                                     const Instant& instant, std::size_t candidate);

/// The tiles side by side, at most three in a row, with the meaning of the colours below; `plots` under them.
[[nodiscard]] report::Canvas draw_comparison(const std::vector<AnswerTile>& tiles,
                                             const std::vector<report::Plot>& plots);

/// The smallest answer of a candidate over all control points at each instant; where no answer is a distance, a gap.
[[nodiscard]] report::Series smallest_answers(const std::vector<Instant>& instants, std::size_t candidate,
                                              std::string label);
/// The same of the truth, cut off at rho.
[[nodiscard]] report::Series smallest_truth(const std::vector<Instant>& instants, double rho_m);

/// The median over all control points at each instant: of a candidate's answers, and of the truth cut off at rho.
[[nodiscard]] report::Series median_answers(const std::vector<Instant>& instants, std::size_t candidate,
                                            std::string label);
[[nodiscard]] report::Series median_truth(const std::vector<Instant>& instants, double rho_m);

/// The answers of a candidate for one control point, and its truth, cut off at rho.
[[nodiscard]] report::Series point_answers(const std::vector<Instant>& instants, std::size_t candidate,
                                           std::size_t point, std::string label);
[[nodiscard]] report::Series point_truth(const std::vector<Instant>& instants, std::size_t point, double rho_m);

}  // namespace depthgrid::experiments
