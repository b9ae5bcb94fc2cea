// What images do to a space: it grows until their exposure, they carve, and their surfaces count. Internal.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "depthgrid/memory/blocking_pixels.hpp"
#include "depthgrid/memory/depth_planes.hpp"
#include "depthgrid/memory/history.hpp"
#include "depthgrid/memory/possible_space.hpp"
#include "depthgrid/memory/seeds.hpp"
#include "depthgrid/memory/settings.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid::memory {

struct Intake {
  std::int64_t images = 0;
  std::int64_t impossible = 0;  ///< voxels, see Seeded
};

/// Scratch memory is allocated by the constructor. For one thread at a time.
class ImageIntake {
 public:
  ImageIntake(const views::ViewStore& views, const MemorySettings& settings);

  /// These cameras' images (a bit each), earlier exposures first; each image once. `history` is told what becomes of
  /// the space.
  [[nodiscard]] Intake take(const views::Snapshot& snapshot, std::uint32_t cameras, PossibleSpace& space,
                            History& history) noexcept;
  /// From here on images that were exposed earlier take nothing out.
  void ignore_before(double time_s) noexcept;

 private:
  void take_one(const views::Snapshot& snapshot, std::size_t camera, PossibleSpace& space, History& history,
                Intake& result) noexcept;

  double thinnest_hidden_m_;
  double ignored_before_s_;
  std::array<std::uint64_t, views::kMaxCameras> taken_{};  ///< versions
  DepthPlanes planes_;
  std::vector<BlockingPixels> blocking_;  ///< a camera each
  std::vector<Block> blocks_;
  SeedScratch seeds_;
};

}  // namespace depthgrid::memory
