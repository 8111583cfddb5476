#pragma once
// Versions of one machine's settings on disk, each with the time and a reason. Any thread, one at a time.
//
//   FOLDER/0001.settings, FOLDER/0002.settings, …   the numbers only grow
//
// Each file is a settings text (settings_text.hpp), so that people can read it, compare it with any tool and give it to
// `kerf settings restore` or `kerf virtual --settings`. Its first remarks are the label:
//
//   ; taken: 2026-11-22 13:40:05 UTC
//   ; reason: $110=600 by hand
//   ; machine: grblHAL 1.1f (build 20260817), axes XYZ, …
//
// A version is written beside its place and renamed: a crash leaves all of it or nothing. A file that cannot be read is
// passed over. Rejected: one file with patches (a bad line would lose everything after it), a database (nobody could
// read it with a pager), git (a program more to depend on). Passwords are never written.

#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "io/machine_url.hpp"
#include "io/text_file.hpp"
#include "sender/machine/settings_plan.hpp"

namespace kerf::io {

/// One version. `settings` are in the order of the file.
struct SettingsVersion {
  int number = 0;
  std::string taken{};
  std::string reason{};
  std::string machine{};
  std::string path{};
  std::vector<machine::SettingAssignment> settings{};
};
BOOST_DESCRIBE_STRUCT(SettingsVersion, (), (number, taken, reason, machine, path, settings))

class SettingsArchive {
 public:
  /// An empty folder name: there is no place to keep anything, and nothing is kept.
  explicit SettingsArchive(std::string folder) : folder_(std::move(folder)) {}

  /// Oldest first.
  [[nodiscard]] std::vector<SettingsVersion> versions() const;
  [[nodiscard]] std::optional<SettingsVersion> latest() const;
  [[nodiscard]] std::optional<SettingsVersion> find(int number) const;

  /// Keeps the machine's settings as a new version, unless the latest has the same. The number of the new one; 0 if
  /// there was nothing to keep.
  std::expected<int, FileError> store(const machine::Capabilities& machine, std::string_view reason,
                                      std::string_view taken) const;

  [[nodiscard]] const std::string& folder() const { return folder_; }

 private:
  [[nodiscard]] std::vector<int> numbers() const;
  [[nodiscard]] std::string path_of(int number) const;

  std::string folder_;
};

/// A name for the machine at the other end that stays the same when it is plugged into another port: its network
/// address where it tells one, else the serial number of its USB device, else the address that it was reached at; and
/// its firmware. Empty for a virtual machine inside this process, which forgets everything.
[[nodiscard]] std::string machine_identity(const MachineUrl& url, const machine::Capabilities& machine);

/// The archive of that machine.
[[nodiscard]] SettingsArchive settings_archive_of(const MachineUrl& url, const machine::Capabilities& machine);

/// "2026-11-22 13:40:05 UTC"
[[nodiscard]] std::string wall_clock_text();

}  // namespace kerf::io
