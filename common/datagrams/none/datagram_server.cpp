#include "common/datagrams/datagram_server.h"

#include "common/base/error.h"

namespace vantage {

DatagramServer::DatagramServer(const std::vector<SocketAddress>&, std::string rig,
                               const std::string& option) {
    fail(
        "rig {}: {} = \"srt\" needs libsrt, and this program was built without VANTAGE_SRT: set it "
        "to \"tcp\"",
        rig, option);
}
DatagramServer::~DatagramServer() = default;

std::vector<DatagramServer::Road> DatagramServer::serve(const std::vector<Peer>&, MonotonicTime) {
    return {};
}
bool DatagramServer::send(std::uint64_t, const FrameParts&) { return false; }

}  // namespace vantage
