/* Has the worker program measure this machine's speed, in the background, where that was not yet done. */
#ifndef CALIBRATOR_H
#define CALIBRATOR_H

/* Starts `PROGRAM calibrate --data FOLDER` at the lowest priority and forgets about it: estimates are made from the
 * built-in figures until the file is there, and for ever where it can't be made. */
void calibrator_start(const char *program, const char *folder);

#endif
