#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/base/files/unique_fd.h"

namespace vantage {

/// What a road does to the packets that go one way, by their count and never by chance: the same
/// packets meet the same every time. 0: none.
struct RoadTrouble {
    unsigned lose_every = 0;          ///< every n-th packet is lost
    unsigned lose_run = 1;            ///< and so many in a row
    std::size_t lose_over_bytes = 0;  ///< larger packets are lost, and nobody is told
    unsigned duplicate_every = 0;     ///< every n-th packet comes twice
    unsigned corrupt_every = 0;       ///< of every n-th packet one byte is another
    unsigned late_every = 0;          ///< every n-th packet comes `late_by` after its time
    std::chrono::milliseconds late_by{0};
    std::chrono::microseconds delay{0};  ///< of all packets
    bool is_down = false;                ///< nothing comes through
    bool only_udp = false;               ///< other packets have no trouble
};

/// A place for rigs, as far away as another computer: a network namespace of its own, joined to
/// this one by a pair of TUN devices, between which a thread carries packets with the trouble that
/// is asked for. While it lives the thread that made it is in a namespace with nothing else but
/// loopback; nothing of the computer's network is touched. Needs no rights where users may have
/// namespaces of their own.
class ImpairedRoad {
  public:
    static constexpr const char* rig_address = "10.77.0.2";

    /// Empty, or why there cannot be one here.
    static std::string reason_against();

    /// Throws Error if it cannot be made. The first one of a process wants it to have no other
    /// thread, unless it runs as root.
    ImpairedRoad();
    ~ImpairedRoad();
    ImpairedRoad(const ImpairedRoad&) = delete;
    ImpairedRoad& operator=(const ImpairedRoad&) = delete;

    /// Does this where the rigs are: sockets that are made, and programs that are started.
    void at_the_rigs(const std::function<void()>& work) const;

    /// From now on, both ways.
    void impair(const RoadTrouble& trouble) { impair(trouble, trouble); }
    /// From now on, each way its own.
    void impair(const RoadTrouble& to_rigs, const RoadTrouble& from_rigs);

    struct Counts {
        std::uint64_t came = 0, lost = 0, duplicated = 0, corrupted = 0, late = 0;
        std::uint64_t bytes = 0;  ///< of what came, also of what was lost then
    };
    /// Of both ways together.
    Counts counts() const;

  private:
    using Time = std::chrono::steady_clock::time_point;
    struct Way {
        std::uint64_t packets = 0;
        std::multimap<Time, std::vector<std::byte>> under_way;
    };

    void carry();
    void take_in(std::size_t end);
    void deliver(int to, Way& way, Time now) const;

    UniqueFd home_, host_place_, rig_place_, wake_;
    std::array<UniqueFd, 2> ends_;  ///< the host's device, the rigs'
    std::array<Way, 2> ways_;       ///< from each end; the carrying thread's
    mutable std::mutex mutex_;
    std::array<RoadTrouble, 2> troubles_;  ///< of each way
    Counts counts_;
    std::atomic<bool> stopping_ = false;
    std::thread carrier_;
};

}  // namespace vantage
