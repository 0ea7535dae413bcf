// gltf_validator.mjs FILE: a line for each issue, "CODE POINTER", without extensions that the
// validator does not know.
import { readFileSync } from 'node:fs';
import { load } from './node_package.mjs';

const { default: validator } = await load('gltf-validator');
const found = await validator.validateBytes(new Uint8Array(readFileSync(process.argv[2])), {
  maxIssues: 0, ignoredIssues: ['UNSUPPORTED_EXTENSION']
});
for (const { code, pointer } of found.issues.messages) console.log(code, pointer);
