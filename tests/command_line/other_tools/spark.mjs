// spark.mjs IN OUT.spz: what Spark's parsers read, as Spark writes it. It needs SH of degree 1 or more.
import { readFileSync, writeFileSync } from 'node:fs';
import { setTimeout as sleep } from 'node:timers/promises';
import { load } from './node_package.mjs';

const spark = await load('@sparkjsdev/spark', 'spark.module.js');
const [from, to] = process.argv.slice(2);

// Spark compiles its WebAssembly by itself and does not say when it is done.
async function transcoded(tries) {
  try {
    const read = { fileBytes: new Uint8Array(readFileSync(from)), pathOrUrl: from };
    return await spark.transcodeSpz({ inputs: [read] });
  } catch (error) {
    if (tries === 0 || !(error instanceof TypeError)) throw error;
    await sleep(50);
    return transcoded(tries - 1);
  }
}
writeFileSync(to, (await transcoded(100)).fileBytes);
