#include "common/datagrams/datagram_link.h"

namespace vantage {

DatagramLink::DatagramLink(const SocketAddress& rig, const DatagramOffer& offer,
                           const WakeEvent& arrived)
    : rig_(rig), offer_(offer), arrived_(arrived) {
    state_.trouble =
        "the rig offers SRT, and the host's program was built without VANTAGE_SRT, which needs "
        "libsrt";
}
DatagramLink::~DatagramLink() = default;

std::optional<std::vector<std::byte>> DatagramLink::next() { return std::nullopt; }
DatagramLink::State DatagramLink::state() const { return state_; }

}  // namespace vantage
