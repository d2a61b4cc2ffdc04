#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/take/kept_frame.h"

namespace vantage {

/// The takes of one rig in the folder that fetched frames go to. Each stands under its own name
/// from the start, as takes do, so that a fetch that was broken off goes on behind what is there.
class FetchedFiles {
  public:
    /// `show`: as TakeFacts. Takes that cannot be read are passed over, with a line in the log.
    FetchedFiles(std::filesystem::path folder, std::string rig, nlohmann::ordered_json show);
    /// What is written by then opens.
    ~FetchedFiles();
    FetchedFiles(FetchedFiles&&) = default;
    FetchedFiles& operator=(FetchedFiles&&) = delete;

    /// Pulses of frames that were in the folder already, in order.
    const std::vector<std::uint64_t>& there() const { return there_; }
    /// Into the file at hand, or another one where its pictures do not fit that or its pulse is not
    /// after that of the frame before. Throws Error if the disk fails.
    void add(const KeptFrame& frame);
    /// Closes the file at hand.
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
