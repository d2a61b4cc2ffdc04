#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "common/base/files/unique_fd.h"

namespace vantage {

/// Reads the elements of an EBML file without their content, so that a take of hours is indexed in
/// seconds, and a damaged place is known by its offset. Only bytes() is thread-safe.
class EbmlFile {
  public:
    struct Element {
        std::uint64_t id = 0;
        std::uint64_t at = 0;      ///< offset of its first byte
        std::uint64_t inside = 0;  ///< offset of its content
        std::uint64_t end = 0;     ///< one past its content
        bool is_open = false;      ///< of unknown size: it ends with its parent
    };

    /// Throws Error if the file cannot be opened.
    explicit EbmlFile(const std::filesystem::path& path);

    std::uint64_t size() const { return size_; }
    /// The element at `at`, which has to end by `limit`; empty if there is none.
    std::optional<Element> element(std::uint64_t at, std::uint64_t limit);
    /// The next offset of `id`, an identifier of four bytes, from `from` on; empty if none.
    std::optional<std::uint64_t> find(std::uint32_t id, std::uint64_t from);

    /// Reads bytes. Thread-safe. Throws Error if the file does not have them.
    std::vector<std::byte> bytes(std::uint64_t at, std::size_t count) const;
    std::vector<std::byte> content(const Element& element) const {
        return bytes(element.inside, element.end - element.inside);
    }
    /// The number or text in an element; empty if it is too long for one.
    std::optional<std::uint64_t> number(const Element& element);

    /// A number of EBML's variable length, with its length in bytes.
    struct VarInt {
        std::uint64_t value = 0;
        std::size_t length = 0;
        bool is_unknown = false;  ///< all bits set: an unknown size
    };
    static std::optional<VarInt> var_int(std::span<const std::byte> bytes);

  private:
    std::span<const std::byte> window(std::uint64_t at, std::size_t count);

    std::filesystem::path path_;
    UniqueFd fd_;
    std::uint64_t size_ = 0;
    std::uint64_t window_at_ = 0;
    std::vector<std::byte> window_;
};

}  // namespace vantage
