#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// A RossTalk command of those that say what is to be done and not how: GPI n, XPT D:S.
struct RossTalkOrder {
    enum class Kind { gpi, xpt } kind = Kind::gpi;
    int first = 0, second = 0;  ///< the number; destination and source
    bool operator==(const RossTalkOrder&) const = default;
};

/// What a line says, without its end. Nothing: it is no such command (case counts), and `is_known`
/// whether it begins as one does.
struct RossTalkLine {
    std::optional<RossTalkOrder> order;
    bool is_known = false;
};
RossTalkLine parse_rosstalk(std::string_view line);

/// Takes the bytes of a connection apart into lines that end CR LF.
class RossTalkLines {
  public:
    void take(std::string_view bytes) { waiting_ += bytes; }
    /// The next whole line without its end; nothing: none has come yet.
    std::optional<std::string> next();
    /// More came without an end than a line has; nothing of it is worth waiting for.
    bool is_flooded() const { return waiting_.size() > most_line_bytes; }

    static constexpr std::size_t most_line_bytes = 128;

  private:
    std::string waiting_;
};

}  // namespace vantage
