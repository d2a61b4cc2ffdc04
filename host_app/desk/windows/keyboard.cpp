#include "host_app/desk/windows/keyboard.h"

#include <utility>

#include <fmt/format.h>

namespace vantage {
namespace {

/// The GLFW keys that print a character, by their place on a US keyboard; GLFW numbers them by
/// ASCII.
constexpr std::string_view printing_keys = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789'`,-./;=[]\\";

bool is_letter(int key) { return key >= 'A' && key <= 'Z'; }
bool is_digit(int key) { return key >= '0' && key <= '9'; }

}  // namespace

KeyCaps::KeyCaps(std::function<std::string(int key)> label_of, std::string signs)
    : label_of_(std::move(label_of)), signs_(std::move(signs)) {}

int KeyCaps::cap_of(int key) const {
    const std::string label = label_of_(key);
    if (label.size() != 1) return 0;
    const auto letter = static_cast<unsigned char>(label.front());
    return letter >= 'a' && letter <= 'z' ? letter - 'a' + 'A' : letter;
}

int KeyCaps::meant_by(int key) const {
    const bool prints = key > 0 && key < 128 &&
                        printing_keys.find(static_cast<char>(key)) != std::string_view::npos;
    if (!prints || is_digit(key)) return key;
    const int cap = cap_of(key);
    if (is_letter(cap)) return cap;
    if (cap != 0 && signs_.find(static_cast<char>(cap)) != std::string::npos) return cap;
    // The cap has no sign of a command. The place counts, unless another cap has its sign.
    for (const char other : printing_keys)
        if (other != key && !is_digit(other) && cap_of(other) == key) return -1;
    return key;
}

int KeyCaps::place_of(int meant) const {
    if (meant_by(meant) == meant) return meant;
    for (const char key : printing_keys)
        if (meant_by(key) == meant) return key;
    return -1;
}

std::string KeyCaps::words() const {
    std::string words;
    for (const char meant : printing_keys) {
        const bool is_used = is_letter(meant) || signs_.find(meant) != std::string::npos;
        if (!is_used || meant_by(meant) == meant) continue;
        const int place = place_of(meant);
        words += fmt::format(
            "{}{} is {}", words.empty() ? "" : ", ", meant,
            place < 0 ? std::string("on no key")
                      : fmt::format("where a US keyboard has {}", static_cast<char>(place)));
    }
    return words;
}

}  // namespace vantage
