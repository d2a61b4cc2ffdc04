#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "host_app/output/picture_sink.h"

namespace vantage {

/// A sink as the programme sees it.
struct SinkState {
    std::string name;
    std::uint64_t pictures = 0;
    std::string failure;  ///< empty: it works
};

/// All that the programme's pictures go to. What fails is closed, logged, and the others go on.
class PictureSinks {
  public:
    /// Before the first picture.
    void add(std::unique_ptr<PictureSink> sink);
    void give(const ProgrammePicture& picture);
    /// After the last picture.
    void finish();
    /// Of those with a name. Thread-safe.
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
