// Runs a program of an image of WebAssembly: node node.mjs IMAGE PROGRAM
import { readFileSync, writeSync } from "node:fs";

const [file, wanted] = process.argv.slice(2);
let take = (text) => writeSync(1, text);
const image = new WebAssembly.Module(readFileSync(file));
const { exports } = new WebAssembly.Instance(image, {
    env: { take: (start, length) => take(new Uint8Array(exports.memory.buffer, start, length)) },
});

const print = take;
let name;
take = (text) => { name = new TextDecoder().decode(text); };
let index = 0;
while (exports.name(index) && name !== wanted) index += 1;
take = print;
process.exitCode = name === wanted && exports.run(index) ? 0 : 1;
