/* Not Arduino's header: our own declarations of the public functions that the example sketch uses. */
#include <stdint.h>
#define OUTPUT 1
enum { A0 = 14, A1, A2 };
uint32_t micros();
int analogRead(uint8_t pin);
void analogWrite(uint8_t pin, int value);
void pinMode(uint8_t pin, uint8_t mode);
