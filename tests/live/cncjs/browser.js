// What a browser is to cncjs: a socket.io client that is signed in. Runs in the folder where cncjs is installed.
//
//   node browser.js URL      every line of standard input is a JSON array, emitted as it is;
//                            every event of cncjs is printed as a JSON array, one a line
'use strict';

const path = require('path');
const readline = require('readline');

const io = require(path.resolve('node_modules', 'socket.io-client'));

const say = (...event) => process.stdout.write(`${JSON.stringify(event)}\n`);
const url = process.argv[2];

async function signIn() {
  const answer = await fetch(`${url}/api/signin`, {
    method: 'POST',
    headers: { 'content-type': 'application/json' },
    body: '{}',
  });
  return (await answer.json()).token;
}

function listen(socket) {
  const onevent = socket.onevent;
  socket.onevent = (packet) => {
    say(...packet.data);
    onevent.call(socket, packet);
  };
  socket.on('connect', () => say('connected'));
  for (const fault of ['error', 'connect_error', 'disconnect']) {
    socket.on(fault, (reason) => say(fault, String(reason)));
  }
}

signIn().then((token) => {
  const socket = io(url, { query: { token }, transports: ['websocket'] });
  listen(socket);
  readline.createInterface({ input: process.stdin })
    .on('line', (line) => socket.emit(...JSON.parse(line)))
    .on('close', () => process.exit(0));
});
