// Stands in for foreign_peers.cpp where DEPTHGRID_BUILD_PEERS is off.
#include "lab/peers/peer.hpp"

namespace depthgrid::bench {

std::vector<PeerKind> foreign_peers() { return {}; }

}  // namespace depthgrid::bench
