#pragma once

namespace thalweg {

/// Gives back an array's memory: `array = {}` and `clear` keep it.
template <class Array>
void release(Array& array) {
  Array().swap(array);
}

}  // namespace thalweg
