// How fast a program becomes what a screen can draw: until the first piece, and all of it.
// usage: toolpath [MEGABYTES]

#include <charconv>
#include <cstdio>
#include <string>
#include <string_view>

#include "measure.hpp"
#include "programs.hpp"
#include "rehearsal/toolpath_stream.hpp"

using namespace kerf;

namespace {

/// A program of about so many bytes: a short one, again and again.
std::string text_of(const bench::BenchProgram& program, std::size_t size_bytes) {
  std::string body = program.text;
  for (const std::string_view end : {"M30\n", "M2\n"}) {
    if (body.ends_with(end)) body.resize(body.size() - end.size());
  }
  std::string text;
  while (text.size() < size_bytes) text += body;
  return text;
}

void measure(const bench::BenchProgram& program, std::size_t size_bytes) {
  constexpr double kMega = 1e6;
  constexpr double kMilli = 1e3;
  const std::string text = text_of(program, size_bytes);
  simulation::CaseMachine machine{.personality = firmware::personality_of(vocabulary::Firmware::GrblHal)};
  static_cast<void>(firmware::apply_settings_text(machine.stored, program.settings));
  const auto start = rehearsal::path_start_of(machine);
  rehearsal::ToolpathStream stream(text, start, "");
  std::size_t bytes = 0;
  const auto first = bench::time([&] { bytes += stream.next().value_or("").size(); });
  const auto rest = bench::time([&] {
    while (const auto piece = stream.next()) bytes += piece->size();
  });
  std::uint64_t vertices = 0;
  const auto read = bench::time([&] {
    rehearsal::ToolpathReader reader(text, start);
    rehearsal::PathChunk chunk;
    constexpr std::size_t kVertices = 16'384;
    while (reader.read_on(chunk, kVertices)) {
    }
    vertices = reader.vertex_count();
  });
  std::printf(
      "%-10s %6.0f MB: first piece after %.1f ms; all of it %.0f MB/s, %.2f M vertices/s, %.2f bytes a byte; without "
      "levels and bytes %.2f M vertices/s\n",
      std::string{program.name}.c_str(), static_cast<double>(text.size()) / kMega, first.wall_s * kMilli,
      static_cast<double>(text.size()) / kMega / rest.cpu_s, static_cast<double>(vertices) / kMega / rest.cpu_s,
      static_cast<double>(bytes) / static_cast<double>(text.size()),
      static_cast<double>(vertices) / kMega / read.cpu_s);
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t megabytes = 100;
  if (argc > 1) {
    const std::string_view text = argv[1];
    std::from_chars(text.data(), text.data() + text.size(), megabytes);
  }
  constexpr std::size_t kMega = 1'000'000;
  constexpr int kLines = 100'000;
  for (const auto& program : bench::all_programs(kLines)) measure(program, megabytes * kMega);
}
