// `kerf log list` and `kerf log show`.

#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/log_lines.hpp"
#include "apps/output.hpp"
#include "io/json.hpp"
#include "io/wire_log.hpp"
#include "io/wire_log_reader.hpp"

namespace kerf::apps {

/// A row of `kerf log list --json`.
struct LogRow {
  std::string path;
  std::string machine{};
  std::string began{};
  std::uint32_t part = 1;
  std::uint64_t size_bytes = 0;
};
BOOST_DESCRIBE_STRUCT(LogRow, (), (path, machine, began, part, size_bytes))

namespace {

std::expected<LogFilter, std::string> filter_of(const LogShowOptions& options) {
  LogFilter filter{.kinds = options.kinds, .hidden = options.hidden, .since = options.since, .until = options.until};
  if (options.direction == "sent") filter.direction = LogDirection::Sent;
  if (options.direction == "received") filter.direction = LogDirection::Received;
  for (const std::string& moment : {options.since, options.until}) {
    if (!moment.empty() && !is_moment(moment)) {
      return std::unexpected(
          fmt::format("'{}' is no moment: write seconds such as 12.5, 13:05:01 or 2026-11-22T13:05:01.", moment));
    }
  }
  if (options.pattern.empty()) return filter;
  try {
    filter.pattern.emplace(options.pattern);
  } catch (const std::regex_error&) {
    return std::unexpected(fmt::format("'{}' is no regular expression: put \\ before ( [ * + ?.", options.pattern));
  }
  return filter;
}

void show(const std::vector<LogEntry>& entries, const LogFilter& filter, const LogShowOptions& options) {
  for (const LogEntry& entry : entries) {
    if (!passes(filter, entry)) continue;
    if (options.json) {
      put("{}\n", io::print(io::to_json(entry)));
    } else {
      put("{}\n", shown(entry, options.by_clock));
    }
  }
}

}  // namespace

ExitStatus show_log(const LogShowOptions& options) {
  const auto filter = filter_of(options);
  if (!filter) {
    complain(filter.error());
    return ExitStatus::Usage;
  }
  const std::string path = io::find_log(options.log, io::log_folder());
  if (path.empty()) {
    complain(fmt::format("There is no log in {} yet: connect to a machine first.", io::log_folder()));
    return ExitStatus::Usage;
  }
  LogLines lines;
  for (const std::string& part : io::parts_of(path, false)) {
    auto reader = io::WireLogReader::open(part);
    if (!reader) {
      complain(io::explain(reader.error(), part));
      return ExitStatus::Usage;
    }
    while (const auto record = reader->next()) show(lines.read(*record), *filter, options);
    if (!reader->remark().empty()) complain(fmt::format("{}: {}.", part, reader->remark()));
  }
  show(lines.finish(), *filter, options);
  return ExitStatus::Done;
}

ExitStatus list_logs(const LogListOptions& options) {
  const std::string folder = options.folder.empty() ? io::log_folder() : options.folder;
  std::vector<LogRow> rows;
  for (const std::string& path : io::list_logs(folder)) {
    LogRow row{.path = path};
    std::error_code ignored;
    row.size_bytes = std::filesystem::file_size(path, ignored);
    auto reader = io::WireLogReader::open(path);
    const auto first = reader ? reader->next() : std::nullopt;
    if (const auto* header = first ? std::get_if<session::LogHeader>(&first->what) : nullptr) {
      row.machine = header->machine;
      row.began = header->began;
      row.part = header->part;
    }
    rows.push_back(std::move(row));
  }
  if (options.json) {
    put("{}\n", io::print(io::to_json(rows), 2));
    return ExitStatus::Done;
  }
  for (const LogRow& row : rows) {
    put("{:<24} {:>9} {:<28} {}\n", row.began, fmt::format("{} kB", (row.size_bytes + 1023) / 1024), row.machine,
        row.path);
  }
  if (rows.empty()) put("There is no log in {}.\n", folder);
  return ExitStatus::Done;
}

}  // namespace kerf::apps
