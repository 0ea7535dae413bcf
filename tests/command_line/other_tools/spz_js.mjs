// spz_js.mjs IN OUT: from one of .ply, .compressed.ply and .spz to another, by spz-js.
import { createReadStream, readFileSync, writeFileSync } from 'node:fs';
import { Readable } from 'node:stream';
import { load } from './node_package.mjs';

const spz = await load('spz-js');
const [from, to] = process.argv.slice(2);
const stream = () => Readable.toWeb(createReadStream(from));
const read = () => from.endsWith('.spz') ? spz.loadSpz(readFileSync(from))
  : from.endsWith('.compressed.ply') ? spz.loadCompressedPly(stream()) : spz.loadPly(stream());
const written = cloud => to.endsWith('.spz') ? spz.serializeSpz(cloud)
  : to.endsWith('.compressed.ply') ? spz.serializeCompressedPly(cloud) : spz.serializePly(cloud);
writeFileSync(to, new Uint8Array(await written(await read())));
