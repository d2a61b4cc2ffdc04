#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/take/kept_frame.h"

namespace vantage {

/// Writes the frames fetched from one rig to takes in a folder. Each take has its final name from
/// the start, so that an interrupted fetch resumes. Not thread-safe.
class FetchedFiles {
  public:
    /// `show`: for TakeFacts. Takes that cannot be read are skipped and logged.
    FetchedFiles(std::filesystem::path folder, std::string rig, nlohmann::ordered_json show);
    /// Leaves the last file readable.
    ~FetchedFiles();
    FetchedFiles(FetchedFiles&&) = default;
    FetchedFiles& operator=(FetchedFiles&&) = delete;

    /// The pulses of frames that the folder had already, in order.
    const std::vector<std::uint64_t>& there() const { return there_; }
    /// Writes a frame to the current file, or to a new one if its images do not fit or its pulse is
    /// not later than the previous one. Throws Error if the disk fails.
    void add(const KeptFrame& frame);
    /// Closes the current file.
    void finish();

    const std::vector<std::filesystem::path>& files() const { return files_; }

  private:
    void begin(const KeptFrame& frame);

    std::filesystem::path folder_;
    std::string rig_;
    nlohmann::ordered_json show_;
    std::vector<std::uint64_t> there_;
    std::unique_ptr<TakeWriter> writer_;
    std::uint64_t last_pulse_ = 0;
    std::vector<std::filesystem::path> files_;
};

}  // namespace vantage
