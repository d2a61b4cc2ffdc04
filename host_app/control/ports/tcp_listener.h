#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/base/files/unique_fd.h"
#include "host_app/output/output_url.h"

namespace vantage {

/// TCP server on every address of a place, with its connections. Use it from one thread.
class TcpListener {
  public:
    /// Throws Error, with `what` as the server's name, if the place is taken.
    TcpListener(const NetworkPlace& place, std::string what, std::size_t most_peers);

    /// Accepts connections and reads their bytes; waits for at most the given time. Throws Error if
    /// the socket has failed.
    struct Arrived {
        int peer = 0;       ///< unique number of the connection
        std::string bytes;  ///< empty: the connection is closed
    };
    std::vector<Arrived> receive(std::chrono::milliseconds most);
    void close(int peer);
    /// Number of connections that were refused because there were too many.
    std::uint64_t turned_away() const { return turned_away_; }

  private:
    struct Peer {
        int number = 0;
        UniqueFd fd;
    };
    void let_in();

    std::string what_;
    std::size_t most_peers_;
    std::vector<UniqueFd> fds_;  ///< one for each address
    std::vector<Peer> peers_;
    int next_number_ = 1;
    std::uint64_t turned_away_ = 0;
};

}  // namespace vantage
