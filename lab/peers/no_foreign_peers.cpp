// Stands in for foreign_peers.cpp where DEPTHGRID_BUILD_PEERS is off.
#include "lab/peers/peer.hpp"

namespace depthgrid::lab {

std::vector<PeerKind> foreign_peers() { return {}; }

}  // namespace depthgrid::lab
