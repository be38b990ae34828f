// splat_figures.mjs same OURS.ply CLIENT.csv      every name in its order and every value, as the same float
// splat_figures.mjs bounds INFO.json CLIENT.csv   count and bounds that sinew info tells
// splat_figures.mjs rigid OURS.ply CLIENT.ply     places, covariances and colours seen from random directions
// splat_figures.mjs pose A,B,C X,Y,Z              a pose file: what the client's --rotate A,B,C --translate X,Y,Z does
//
// Reads splat files by itself. With PLANT=NAME in the environment the values of that column of OURS are changed a
// little first: the comparison must then fail.

import fs from 'node:fs';

const fail = (message) => {
  console.log(message);
  process.exit(1);
};

function readPly(path) {
  const bytes = fs.readFileSync(path);
  const end = bytes.indexOf('end_header\n') + 'end_header\n'.length;
  const header = bytes.subarray(0, end).toString();
  if (!header.startsWith('ply\nformat binary_little_endian')) fail(`${path}: expected a binary PLY`);
  const names = [...header.matchAll(/^property float (\S+)$/gm)].map((match) => match[1]);
  const count = Number(header.match(/^element vertex (\d+)$/m)[1]);
  if (bytes.length !== end + 4 * names.length * count) fail(`${path}: expected ${count} rows of ${names.length} floats`);
  const values = new Float32Array(bytes.buffer.slice(bytes.byteOffset + end, bytes.byteOffset + bytes.length));
  return { names, count, values };
}

function readCsv(path) {
  const [head, ...lines] = fs.readFileSync(path, 'utf8').trimEnd().split('\n');
  const names = head.trim().split(',');
  const values = new Float32Array(lines.length * names.length);
  lines.forEach((line, row) => {
    const cells = line.trim().split(',');
    if (cells.length !== names.length) fail(`${path}: expected ${names.length} values in row ${row}`);
    cells.forEach((cell, column) => (values[row * names.length + column] = Number(cell)));
  });
  return { names, count: lines.length, values };
}

function readOurs(path) {
  const ours = readPly(path);
  const column = ours.names.indexOf(process.env.PLANT ?? '');
  if (column >= 0) for (let i = column; i < ours.values.length; i += ours.names.length) ours.values[i] += 0.1;
  return ours;
}

function same(ours, client) {
  if (ours.names.join() !== client.names.join()) fail(`names: ${ours.names}\nclient: ${client.names}`);
  if (ours.count !== client.count) fail(`${ours.count} splats, the client has ${client.count}`);
  for (let i = 0; i < ours.values.length; ++i)
    if (!Object.is(ours.values[i], client.values[i]) && !(ours.values[i] === 0 && client.values[i] === 0))
      fail(`${ours.names[i % ours.names.length]} of splat ${Math.floor(i / ours.names.length)}: ` +
        `${ours.values[i]}, the client has ${client.values[i]}`);
  console.log(`${ours.count} splats with ${ours.names.length} values each: all equal`);
}

function bounds(info, client) {
  const columns = ['x', 'y', 'z'].map((name) => client.names.indexOf(name));
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < client.count; ++i)
    columns.forEach((column, c) => {
      low[c] = Math.min(low[c], client.values[i * client.names.length + column]);
      high[c] = Math.max(high[c], client.values[i * client.names.length + column]);
    });
  const ours = JSON.stringify([info.points, info.bounds.min, info.bounds.max]);
  const theirs = JSON.stringify([client.count, low, high]);
  if (ours !== theirs) fail(`points and bounds: ${ours}, the client has ${theirs}`);
}

/// Numbers NAME_0 ... of splat i.
const group = (splats, name, count, i, first = 0) =>
  Array.from({ length: count }, (_, k) => splats.values[i * splats.names.length + splats.names.indexOf(name + (first + k))]);

function covariance(splats, i) {
  const q = group(splats, 'rot_', 4, i), s = group(splats, 'scale_', 3, i).map((x) => Math.exp(2 * x));
  const [w, x, y, z] = q.map((c) => c / Math.hypot(...q));
  const R = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]];
  return R.flatMap((a) => R.map((b) => a[0] * b[0] * s[0] + a[1] * b[1] * s[1] + a[2] * b[2] * s[2]));
}

const distance = (a, b) => Math.hypot(...a.map((x, k) => x - b[k]));

function rigid(ours, client) {
  if (ours.count !== client.count) fail(`${ours.count} splats, the client has ${client.count}`);
  const worst = { place: 0, covariance: 0, colour: 0 };
  const rest = ours.names.filter((name) => name.startsWith('f_rest_')).length;
  for (let i = 0; i < ours.count; ++i) {
    const place = (s) => ['x', 'y', 'z'].map((name) => s.values[i * s.names.length + s.names.indexOf(name)]);
    const a = covariance(ours, i), b = covariance(client, i);
    worst.place = Math.max(worst.place, distance(place(ours), place(client)) / (1 + Math.hypot(...place(client))));
    worst.covariance = Math.max(worst.covariance, distance(a, b) / Math.hypot(...b));
    const x = group(ours, 'f_rest_', rest, i), y = group(client, 'f_rest_', rest, i);
    worst.colour = Math.max(worst.colour, distance(x, y) / (0.01 + Math.hypot(...y)));
  }
  console.log(`largest differences: place ${worst.place.toExponential(1)}, covariance ` +
    `${worst.covariance.toExponential(1)}, harmonics ${worst.colour.toExponential(1)} (relative)`);
  if (!(worst.place < 1e-5 && worst.covariance < 1e-4 && worst.colour < 1e-4)) process.exit(1);
}

/// The client turns about x, then y, then z, in a world whose x and y point the other way than the file's.
function pose(angles, move) {
  const [a, b, c] = angles.map((degrees) => degrees * Math.PI / 180);
  const product = (A, B) => A.map((row) => [0, 1, 2].map((j) => row[0] * B[0][j] + row[1] * B[1][j] + row[2] * B[2][j]));
  const X = [[1, 0, 0], [0, Math.cos(a), -Math.sin(a)], [0, Math.sin(a), Math.cos(a)]];
  const Y = [[Math.cos(b), 0, Math.sin(b)], [0, 1, 0], [-Math.sin(b), 0, Math.cos(b)]];
  const Z = [[Math.cos(c), -Math.sin(c), 0], [Math.sin(c), Math.cos(c), 0], [0, 0, 1]];
  const flip = [-1, -1, 1], R = product(Z, product(Y, X));
  const map = R.flatMap((row, i) => [...row.map((x, j) => flip[i] * x * flip[j]), flip[i] * move[i]]);
  const binding = [{ name: 'nodes', columns: 3, values: [0, 0, 0] }, { name: 'neighbours', columns: 1, values: [1] }];
  console.log(JSON.stringify({ sinew_pose: 1, origin: [0, 0, 0], layers: [{ method: 'graph', binding, maps: [map] }] }));
}

const [what, first, second] = process.argv.slice(2);
const numbers = (text) => text.split(',').map(Number);
if (what === 'same') same(readOurs(first), readCsv(second));
else if (what === 'bounds') bounds(JSON.parse(fs.readFileSync(first)), readCsv(second));
else if (what === 'rigid') rigid(readOurs(first), readPly(second));
else if (what === 'pose') pose(numbers(first), numbers(second));
else fail(`expected same, bounds, rigid or pose, found ${what}`);
