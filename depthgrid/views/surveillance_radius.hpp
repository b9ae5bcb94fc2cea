// How far to look so that what is found also holds for images that are not new.
#pragma once

namespace depthgrid::views {

/// rho_m + v_max_m_s * greatest_age_s + blind_m, for Settings::rho_m: with "nothing within" this radius at the exposure
/// there is nothing within rho_m of the robot's blind layer as long as the image is no older, while obstacles move at
/// most at v_max_m_s. The greatest age: from the exposure until the image is there, until the next one replaces it, and
/// until distances are asked anew. blind_m: the thickest layer to be expected (Answer::blind_m); 0 where distances
/// count from the robot. Throws Error unless rho is positive, the others are not negative and all are finite.
[[nodiscard]] double surveillance_radius_m(double rho_m, double v_max_m_s, double greatest_age_s, double blind_m);

}  // namespace depthgrid::views
