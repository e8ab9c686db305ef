// What `veronese help` says of each command.

import { help } from '../../pkg/build/cli/help.js';
import { COMMANDS } from '../../pkg/build/cli/commands.js';

const plain = (text) => text;

export default { overview: help(undefined, plain), each: Object.keys(COMMANDS).map((name) => ({ name, text: help(name, plain) })) };
