#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <zmq.hpp>

#include "common/base/log_limiter.h"
#include "common/base/time/time.h"
#include "common/serve/host_admission.h"
#include "common/serve/host_links.h"
#include "common/serve/stranger_watch.h"
#include "common/wire/wake_event.h"

namespace vantage {

/// Serves one rig's frames to any number of hosts, each as fast as it takes them and no faster: the
/// socket, its thread, and the books (HostLinks). With keys, only authorized hosts get in and
/// everything is encrypted; without, only programs on this computer can be served.
class FrameServer {
  public:
    struct Settings {
        std::string bind;                         ///< tcp://HOST:PORT
        std::filesystem::path key_file;           ///< the CURVE key pair hosts know it by
        std::filesystem::path authorized_hosts;   ///< public keys of the hosts, one a line
        int queue_frames = 4;                     ///< that may wait for one host
        const char* bind_option = "stream.bind";  ///< what `bind` is called in a refusal
    };

    /// Throws Error if the endpoint cannot be bound, a key or list cannot be read, or an endpoint
    /// beyond loopback is asked for without keys.
    FrameServer(const Settings& settings, std::string rig, std::uint64_t session);
    ~FrameServer();
    FrameServer(const FrameServer&) = delete;
    FrameServer& operator=(const FrameServer&) = delete;

    /// Does this with the books, under their lock. Any thread. `work` must not wait.
    template <class Work>
    auto change(Work work) {
        const std::lock_guard lock(mutex_);
        return work(links_);
    }
    /// The same; whatever is due to be sent then is sent.
    template <class Work>
    void tell(Work work) {
        change(work);
        wake();
    }
    /// Sends what is due.
    void wake() { wake_.notify(); }
    /// Throws Error if serving came to an end, with the reason.
    void check() const;
    /// Waits until a host's message makes this true of the books. Any thread.
    template <class Question>
    bool wait_for(std::chrono::nanoseconds timeout, Question question) {
        std::unique_lock lock(mutex_);
        return heard_.wait_for(lock, timeout, [&] { return question(links_); });
    }
    /// Lets those go on that wait.
    void wake_waiting() { heard_.notify_all(); }

    /// The first pulse of the take as a host last announced it; 0: none did. Any thread.
    std::uint64_t announced_pulse() const { return announced_pulse_; }
    /// Messages that were no host's. Any thread.
    std::uint64_t malformed() const;
    /// Connections that came to nothing, since whoever opened them is no host. Any thread.
    std::uint64_t refused_connections() const { return refused_connections_; }

    /// With the port that was bound, where the settings left it open.
    const std::string& endpoint() const { return endpoint_; }
    /// Z85; empty without keys.
    const std::string& public_key() const { return public_key_; }

  private:
    void bind(const Settings& settings);
    void run();
    void turn();
    void beat(MonotonicTime now);
    bool receive();
    void send_all();
    bool send(const HostLinks::Outgoing& outgoing);

    const std::string rig_;
    std::string public_key_, endpoint_;

    mutable std::mutex mutex_;  ///< of links_, failure_ and malformed_; never held over a socket
                                ///< call
    HostLinks links_;
    std::string failure_;
    std::uint64_t malformed_ = 0;
    std::condition_variable heard_;
    LogLimiter complaints_, overruns_;  ///< the thread's
    std::string slow_host_;
    std::atomic<std::uint64_t> announced_pulse_ = 0;

    zmq::context_t context_;
    std::optional<HostAdmission> admission_;
    zmq::socket_t router_;
    StrangerWatch strangers_;
    std::atomic<std::uint64_t> refused_connections_ = 0;
    WakeEvent wake_;
    MonotonicTime next_heartbeat_{};
    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

}  // namespace vantage
