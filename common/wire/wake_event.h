#pragma once

namespace vantage {

/// Wakes a thread that polls file descriptors. Thread-safe.
class WakeEvent {
  public:
    WakeEvent();
    ~WakeEvent();
    WakeEvent(const WakeEvent&) = delete;
    WakeEvent& operator=(const WakeEvent&) = delete;

    /// Readable from notify() until clear().
    int fd() const { return fd_; }
    void notify() const;
    void clear() const;

  private:
    int fd_;
};

}  // namespace vantage
