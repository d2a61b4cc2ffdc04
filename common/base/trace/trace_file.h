#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace vantage {

/// Writes the spans of all threads (TraceSpan) to a file in Chrome's trace event format, which
/// Perfetto and chrome://tracing open. Every thread has a lock-free ring of bounded size; a thread
/// of this object empties the rings into the file. Spans that find their ring full are counted and
/// reported, for each thread. The closing bracket comes with the end: a file of a killed program
/// lacks it, as the format allows. One object may exist at a time.
class TraceFile {
  public:
    struct Limits {
        std::size_t spans_per_thread = 4096;
        /// Largest size of the file; later spans are left out, and the log says so. Viewers take
        /// larger files badly.
        std::uint64_t file_bytes = 500'000'000;
        std::chrono::nanoseconds period = std::chrono::milliseconds(50);  ///< between two writes
    };
    /// Begins the file and the recording. `program` names the process in the viewer. Throws Error
    /// if the file exists and `overwrites` is false, or if it cannot be written.
    TraceFile(std::filesystem::path path, const std::string& program, bool overwrites);
    TraceFile(std::filesystem::path path, const std::string& program, bool overwrites,
              Limits limits);
    /// Ends the recording, completes the file and logs what it lacks.
    ~TraceFile();
    TraceFile(const TraceFile&) = delete;
    TraceFile& operator=(const TraceFile&) = delete;

    /// Spans that are in the file, and those that found their ring full, so far.
    std::uint64_t written() const;
    std::uint64_t dropped() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
