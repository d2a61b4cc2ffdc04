#include "common/base/time/time_zone.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include <time.h>

#include "common/base/error.h"

namespace vantage {

bool is_time_zone(const std::string& name) {
    const auto fits = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '/' || c == '_' || c == '-' ||
               c == '+';
    };
    if (name == "UTC") return true;
    if (name.empty() || name.front() == '/' || !std::all_of(name.begin(), name.end(), fits))
        return false;
    std::error_code error;
    return std::filesystem::is_regular_file("/usr/share/zoneinfo/" + name, error);
}

void use_time_zone(const std::string& name) {
    if (!is_time_zone(name))
        fail("the time zone '{}' is not known here; timedatectl list-timezones lists them", name);
    ::setenv("TZ", name.c_str(), 1);
    ::tzset();
}

}  // namespace vantage
