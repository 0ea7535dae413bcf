// A package that npm has installed: where NODE_PATH says, or beside node. `file` is one beside what
// the package gives to require().
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { pathToFileURL } from 'node:url';

const require = createRequire(import.meta.url);

export function load(name, file) {
  const given = require.resolve(name);
  return import(pathToFileURL(file ? join(dirname(given), file) : given));
}
