// embed_page.mjs DIST OUT: writes OUT/page_bytes.S, which takes the files of DIST into a program as they are, and
// OUT/page_table.cpp, which lists them (src/daemon/page_files.hpp).
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { extname, join, relative, resolve, sep } from 'node:path';

const kinds = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8',
  '.json': 'application/json',
  '.webmanifest': 'application/manifest+json',
  '.svg': 'image/svg+xml',
  '.png': 'image/png',
  '.ico': 'image/x-icon',
  '.woff2': 'font/woff2',
};

const [dist, out] = process.argv.slice(2).map((path) => resolve(path));
const files = readdirSync(dist, { recursive: true, withFileTypes: true })
  .filter((entry) => entry.isFile() && !entry.name.endsWith('.gz'))
  .map((entry) => join(entry.parentPath ?? entry.path, entry.name))
  .sort();

let assembly = '// Written by tools/embed_page.mjs.\n.section .rodata\n';
let symbols = '';
let rows = '';
const embed = (path, symbol) => {
  assembly += `.global ${symbol}\n.balign 16\n${symbol}:\n.incbin "${path}"\n.global ${symbol}_end\n${symbol}_end:\n.byte 0\n`;
  symbols += `extern const char ${symbol}[];\nextern const char ${symbol}_end[];\n`;
  return `{${symbol}, static_cast<std::size_t>(${symbol}_end - ${symbol})}`;
};

files.forEach((path, at) => {
  const kind = kinds[extname(path)];
  if (!kind) throw new Error(`${path}: what is this to be served as?`);
  const etag = createHash('sha256').update(readFileSync(path)).digest('hex').slice(0, 24);
  const bytes = embed(path, `kerf_page_${at}`);
  const gzipped = existsSync(`${path}.gz`) ? embed(`${path}.gz`, `kerf_page_${at}_gz`) : '{}';
  const name = '/' + relative(dist, path).split(sep).join('/');
  rows += `    {"${name}", "${kind}", "\\"${etag}\\"", ${bytes}, ${gzipped}},\n`;
});

mkdirSync(out, { recursive: true });
writeFileSync(join(out, 'page_bytes.S'), assembly + '.section .note.GNU-stack,"",%progbits\n');
writeFileSync(
  join(out, 'page_table.cpp'),
  `// Written by tools/embed_page.mjs.
#include <array>

#include "daemon/page_files.hpp"

extern "C" {
${symbols}}

namespace kerf::daemon {

std::span<const PageFile> page_files() {
  static const std::array<PageFile, ${files.length}> kFiles{{
${rows}  }};
  return kFiles;
}

}  // namespace kerf::daemon
`,
);
