#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "common/base/error.h"

namespace vantage {

/// A control group of the kernel (version 1) for programs of a test.
class ControlGroup {
  public:
    /// Empty, or why there cannot be one of this controller here.
    static std::string reason_against(const std::string& controller) {
        const std::filesystem::path tasks = root(controller) / "tasks";
        if (!std::filesystem::exists(tasks))
            return "this kernel has no control groups of version 1 for " + controller;
        if (::access(tasks.c_str(), W_OK) != 0)
            return "this process may make no control groups; run as root";
        return "";
    }

    explicit ControlGroup(const std::string& controller)
        : root_(root(controller)), folder_(root_ / fmt::format("vantage-test-{}", ::getpid())) {
        std::filesystem::create_directory(folder_);
    }
    /// Precondition: its programs have ended.
    ~ControlGroup() { ::rmdir(folder_.c_str()); }
    ControlGroup(const ControlGroup&) = delete;
    ControlGroup& operator=(const ControlGroup&) = delete;

    /// Programs that `work` starts are in the group.
    void run_inside(const std::function<void()>& work) const {
        const std::string thread = std::to_string(::syscall(SYS_gettid));
        write(folder_ / "tasks", thread);
        work();
        write(root_ / "tasks", thread);
    }
    void set(const std::string& file, std::int64_t value) const {
        write(folder_ / file, std::to_string(value));
    }
    std::int64_t value_of(const std::string& file) const {
        std::int64_t value = 0;
        if (!(std::ifstream(folder_ / file) >> value)) fail("cannot read {}", file);
        return value;
    }
    /// Writes to a block device, of all programs; 0: as many as it can. Controller blkio.
    static void limit_writes(const std::string& device_numbers, std::int64_t bytes_a_second) {
        write(root("blkio") / "blkio.throttle.write_bps_device",
              fmt::format("{} {}", device_numbers, bytes_a_second));
    }
    /// Share of one processor that the group gets in each tenth of a second, 0.01 at least; 0: as
    /// much as it wants. Controller cpu.
    void limit_processor(double share) const {
        constexpr int period_us = 100'000;
        set("cpu.cfs_period_us", period_us);
        set("cpu.cfs_quota_us", share > 0 ? static_cast<int>(share * period_us) : -1);
    }

  private:
    static std::filesystem::path root(const std::string& controller) {
        return "/sys/fs/cgroup/" + controller;
    }
    static void write(const std::filesystem::path& file, const std::string& text) {
        if (!(std::ofstream(file) << text << std::flush)) fail("cannot write {}", file.string());
    }

    std::filesystem::path root_, folder_;
};

}  // namespace vantage
