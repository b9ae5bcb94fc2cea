// libFuzzer target: any bytes as a mesh in COLLADA.
#include "mesh_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return try_mesh(data, size, ".dae");
}
