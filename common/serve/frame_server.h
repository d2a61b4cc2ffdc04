#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>
#include <zmq.hpp>

#include "common/base/log_limiter.h"
#include "common/base/time/time.h"
#include "common/datagrams/datagram_server.h"
#include "common/serve/host_admission.h"
#include "common/serve/host_links.h"
#include "common/serve/stranger_watch.h"
#include "common/wire/wake_event.h"

namespace vantage {

/// Serves one rig's frames to any number of hosts, to each at the rate it takes them. Owns the
/// socket, its thread and the accounting (HostLinks). With keys, only authorized hosts are admitted
/// and everything is encrypted; without keys, only programs on this computer are served.
class FrameServer {
  public:
    struct Settings {
        std::string bind;                         ///< tcp://HOST:PORT
        std::filesystem::path key_file;           ///< the rig's CURVE key pair
        std::filesystem::path authorized_hosts;   ///< public keys of the hosts, one per line
        int queue_frames = 4;                     ///< frames that may wait for one host
        const char* bind_option = "stream.bind";  ///< name of `bind` in error messages
        bool offers_datagrams = false;            ///< frames go over SRT to hosts that can take it
    };

    /// Throws Error if the endpoint cannot be bound, a key or the list cannot be read, or an
    /// endpoint beyond loopback has no keys.
    FrameServer(const Settings& settings, std::string rig, std::uint64_t session);
    ~FrameServer();
    FrameServer(const FrameServer&) = delete;
    FrameServer& operator=(const FrameServer&) = delete;

    /// Calls `work` with the accounting, under its lock. Any thread. `work` must not block.
    template <class Work>
    auto change(Work work) {
        const std::lock_guard lock(mutex_);
        return work(links_);
    }
    /// Does the same and then sends what is due.
    template <class Work>
    void tell(Work work) {
        change(work);
        wake();
    }
    /// Makes the thread send what is due.
    void wake() { wake_.notify(); }
    /// Throws Error with the reason if serving ended.
    void check() const;
    /// Waits until a message of a host makes `question` true. Any thread.
    template <class Question>
    bool wait_for(std::chrono::nanoseconds timeout, Question question) {
        std::unique_lock lock(mutex_);
        return heard_.wait_for(lock, timeout, [&] { return question(links_); });
    }
    /// Wakes threads that wait.
    void wake_waiting() { heard_.notify_all(); }

    /// The first trigger pulse as last announced by a host; 0: none. Any thread.
    std::uint64_t announced_pulse() const { return announced_pulse_; }
    /// Number of invalid messages. Any thread.
    std::uint64_t malformed() const;
    /// Number of connections that were not a host's. Any thread.
    std::uint64_t refused_connections() const { return refused_connections_; }

    /// The bound endpoint, with its port.
    const std::string& endpoint() const { return endpoint_; }
    /// In Z85; empty without keys.
    const std::string& public_key() const { return public_key_; }

  private:
    void bind(const Settings& settings);
    /// Listens for SRT at the addresses of the bound endpoints.
    void bind_datagrams(const std::vector<std::string>& endpoints, bool any_port);
    void serve_datagrams(MonotonicTime now);
    void run();
    void turn();
    void beat(MonotonicTime now);
    bool receive();
    /// Refuses a host whose key was removed from the list of authorized hosts while it was
    /// connected, and ends its connection if it speaks on.
    bool is_revoked(const std::string& route, zmq::message_t& part);
    /// Warns if the host's TAI offset differs from this computer's.
    void note_clock(const HostMessage& message, zmq::message_t& part, MonotonicTime now);
    void send_all();
    bool send(const HostLinks::Outgoing& outgoing);

    const std::string rig_;
    std::string public_key_, endpoint_;

    mutable std::mutex mutex_;  ///< guards links_, failure_ and malformed_; never held during a
                                ///< socket call
    HostLinks links_;
    std::string failure_;
    std::uint64_t malformed_ = 0;
    std::condition_variable heard_;
    LogLimiter complaints_, overruns_, clock_complaints_{std::chrono::minutes(1)};  ///< thread only
    std::string slow_host_;
    std::atomic<std::uint64_t> announced_pulse_ = 0;

    zmq::context_t context_;
    std::optional<HostAdmission> admission_;
    std::set<HostLinks::Route> told_;  ///< connections whose host was told that its key was removed
    zmq::socket_t router_;
    StrangerWatch strangers_;
    std::atomic<std::uint64_t> refused_connections_ = 0;
    std::optional<DatagramServer> datagrams_;  ///< empty: frames go over TCP only
    bool waits_for_room_ = false;
    WakeEvent wake_;
    MonotonicTime next_heartbeat_{};
    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

}  // namespace vantage
