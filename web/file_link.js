// A link to something the daemon holds, which also says under which name it is kept.
import { h } from './dom.js';

export const fileLink = (path, text) => h('a', { href: path }, text);
