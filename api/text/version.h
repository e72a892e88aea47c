#ifndef VERSION_H
#define VERSION_H

#define REPOSED_VERSION "0.1.0" /* of both programs */

#endif
