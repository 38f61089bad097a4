//! Memory allocator of both programs: when the system is out of memory, they print a message and end with exit code 1
//! instead of aborting.

use std::alloc::{GlobalAlloc, Layout, System};
use std::ffi::c_int;
use std::io::{Cursor, Write, stderr};

/// The system's allocator.
#[derive(Clone, Copy, Debug)]
pub struct Allocator;

// SAFETY: every call is forwarded to the system's allocator under the same contract; a failed allocation ends the
// program.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the contract.
        had(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the contract.
        had(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller keeps the contract.
        had(unsafe { System.realloc(memory, layout, size) }, size)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract.
        unsafe { System.dealloc(memory, layout) }
    }
}

/// The allocated memory; ends the program if the allocation failed.
#[inline]
fn had(memory: *mut u8, bytes: usize) -> *mut u8 {
    if memory.is_null() {
        end(bytes);
    }
    memory
}

/// Ends the program without allocating memory for the message and without an orderly exit; a launcher ends the other
/// ranks.
#[cold]
fn end(bytes: usize) -> ! {
    unsafe extern "C" {
        fn _exit(code: c_int) -> !;
    }
    let mut text = [0; 192];
    let mut line = Cursor::new(&mut text[..]);
    let _ = writeln!(
        line,
        "error: out of memory: the system has no {bytes} bytes more for this process; expected more memory, or a \
         higher limit (ulimit -v) [--explain out-of-memory]"
    );
    let length = line.position() as usize;
    let _ = stderr().write_all(&text[..length]);
    // SAFETY: `_exit` takes a number and doesn't return.
    unsafe { _exit(1) }
}
