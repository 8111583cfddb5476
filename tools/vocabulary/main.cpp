// Writes the tables of docs/protocol/tables from the code, or checks that they are up to date.
//
//   vocabulary [--check] FOLDER

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "markdown.hpp"

namespace {

using kerf::tools::Page;

std::vector<Page> all_pages() {
  std::vector<Page> pages;
  for (auto* const make : {kerf::tools::vocabulary_pages, kerf::tools::settings_pages, kerf::tools::command_pages,
                           kerf::tools::figure_pages}) {
    auto more = make();
    pages.insert(pages.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
  return pages;
}

std::string read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

int main(int argc, char** argv) {
  const bool checks = argc == 3 && std::string_view{argv[1]} == "--check";
  if (argc != 2 && !checks) {
    std::fputs("usage: vocabulary [--check] FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = argv[argc - 1];
  int stale = 0;
  for (const Page& page : all_pages()) {
    const std::filesystem::path file = folder / page.name;
    if (!checks) {
      std::ofstream(file, std::ios::binary) << page.text;
    } else if (read(file) != page.text) {
      std::fprintf(stderr, "%s is not what the code says: run `make docs` and commit the result.\n",
                   file.string().c_str());
      ++stale;
    }
  }
  return stale == 0 ? 0 : 1;
}
