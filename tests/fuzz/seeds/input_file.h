#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

namespace vantage {

/// The fuzzer's input as a file in memory that loaders can open by its path. It is readable by its
/// owner only.
class InputFile {
  public:
    explicit InputFile(std::span<const std::uint8_t> bytes);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;
    std::filesystem::path path() const;

  private:
    int fd_;
};

/// Runs a decoder on hostile input: it may return or throw Error; any other exception, as any
/// crash, ends the fuzzer.
void expect_result_or_error(const std::function<void()>& decode);

}  // namespace vantage
