#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/base/files/unique_fd.h"
#include "host_app/output/output_url.h"

namespace vantage {

/// TCP sockets that listen at every address of a place, and whoever is connected to them.
class TcpListener {
  public:
    /// Throws Error, naming `what`, if the place is taken.
    TcpListener(const NetworkPlace& place, std::string what, std::size_t most_peers);

    /// Waits for so long at the most, lets in who asks, and takes what has come. Throws Error if
    /// the socket has failed.
    struct Arrived {
        int peer = 0;       ///< a number of its own for every connection
        std::string bytes;  ///< empty: it is gone
    };
    std::vector<Arrived> receive(std::chrono::milliseconds most);
    void close(int peer);
    /// Who was turned away since there were too many.
    std::uint64_t turned_away() const { return turned_away_; }

  private:
    struct Peer {
        int number = 0;
        UniqueFd fd;
    };
    void let_in();

    std::string what_;
    std::size_t most_peers_;
    std::vector<UniqueFd> fds_;  ///< one for each address of the place
    std::vector<Peer> peers_;
    int next_number_ = 1;
    std::uint64_t turned_away_ = 0;
};

}  // namespace vantage
