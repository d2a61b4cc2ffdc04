#pragma once

#include <memory>
#include <string>

namespace vantage {

/// A service that this computer announces to its network by DNS-SD, through Avahi, as long as this
/// lives. Avahi may be started, stopped and started again meanwhile; where there is none, or it
/// refuses, that is said in the log once and all else goes on: whoever knows the address needs
/// none.
class ServiceAnnouncement {
  public:
    /// `name` is what people read, `type` as in "_vantage._tcp". Another service of that name gives
    /// this one a number.
    ServiceAnnouncement(const std::string& name, const std::string& type, int port);
    ~ServiceAnnouncement();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
