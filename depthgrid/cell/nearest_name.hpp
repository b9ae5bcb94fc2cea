// The known name that is nearest to one that somebody mistyped. Internal.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace depthgrid::cell {

/// " (did you mean 'cameras'?)" where a known name is near, else " (known: a, b, c)". Letters that are missing, in
/// excess, exchanged with their neighbour or others count one each; near is up to a third of the name's length, or 2.
[[nodiscard]] std::string suggestion(std::string_view name, std::span<const std::string_view> known);

}  // namespace depthgrid::cell
