#include "depthgrid/monitor/device_says.hpp"

#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::monitor {
namespace {

bool near_to(double told, double wanted, double share) { return std::abs(told - wanted) <= share * wanted; }

}  // namespace

void refuse_other_images(const sensors::SourceInfo& told, const PinholeCamera& wanted) {
  constexpr double kCentre_px = 0.6;  // half a pixel apart are the two conventions
  constexpr double kFocal = 0.002;
  constexpr double kUsual = 0.05;  // calibrations of one kind of device differ by less, its colour camera by more
  if (told.intrinsics) {
    const PinholeCamera& own = *told.intrinsics;
    if (own.width_px != wanted.width_px || own.height_px != wanted.height_px) {
      fail("gives images of ", own.width_px, " x ", own.height_px, " pixels, the cell says ", wanted.width_px, " x ",
           wanted.height_px);
    }
    if (!(near_to(own.fx_px, wanted.fx_px, kFocal) && near_to(own.fy_px, wanted.fy_px, kFocal) &&
          std::abs(own.cx_px - wanted.cx_px) <= kCentre_px && std::abs(own.cy_px - wanted.cy_px) <= kCentre_px)) {
      fail("says fx ", own.fx_px, ", fy ", own.fy_px, ", cx ", own.cx_px, ", cy ", own.cy_px, " px, the cell says ",
           wanted.fx_px, ", ", wanted.fy_px, ", ", wanted.cx_px, ", ", wanted.cy_px);
    }
  }
  if (told.nominal &&
      !(near_to(told.nominal->fx_px, wanted.fx_px, kUsual) && near_to(told.nominal->fy_px, wanted.fy_px, kUsual))) {
    fail("has usually fx ", told.nominal->fx_px, ", fy ", told.nominal->fy_px, " px, the cell says ", wanted.fx_px,
         ", ", wanted.fy_px, ", more than ", 100 * kUsual,
         " % away: intrinsics: of the depth imager (infrared), not of the colour camera");
  }
}

void refuse_other_unit(const DepthView& depth, const RigCamera& wanted) {
  if (depth.format == DepthFormat::uint16_units && depth.metres_per_unit != wanted.metres_per_unit) {
    fail("gives depth in units of ", depth.metres_per_unit, " m, the cell says ", wanted.metres_per_unit,
         ": metres_per_unit: ", depth.metres_per_unit);
  }
}

}  // namespace depthgrid::monitor
