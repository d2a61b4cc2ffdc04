#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "host_app/output/picture_sink.h"

namespace vantage {

/// Status of a sink.
struct SinkState {
    std::string name;
    std::uint64_t pictures = 0;
    std::string failure;  ///< error that closed it; empty: none
};

/// All sinks of the programme's frames. A sink that fails is logged and closed, and the others go
/// on. Used on the programme's thread, except for states().
class PictureSinks {
  public:
    /// To be called before the first frame.
    void add(std::unique_ptr<PictureSink> sink);
    void give(const ProgrammePicture& picture);
    /// To be called after the last frame.
    void finish();
    /// States of the sinks that have a name. Thread-safe.
    std::vector<SinkState> states() const;

  private:
    struct Sink {
        std::unique_ptr<PictureSink> sink;
        SinkState state;
    };
    void note();

    std::vector<Sink> sinks_;
    mutable std::mutex mutex_;
    std::vector<SinkState> states_;
};

}  // namespace vantage
