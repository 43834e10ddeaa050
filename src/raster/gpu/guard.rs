use super::GpuError;
use std::future::Future;
use std::pin::pin;
use std::sync::OnceLock;
use std::task::{Context, Poll, Waker};

/// Catches what goes wrong on a device, which otherwise would be a panic.
pub(super) struct Guard(Vec<wgpu::ErrorScopeGuard>);

impl Guard {
    pub fn new(device: &wgpu::Device) -> Self {
        use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
        Self([Validation, Internal, OutOfMemory].map(|filter| device.push_error_scope(filter)).into())
    }

    pub fn finish(mut self, adapter: &str, lost: &OnceLock<String>) -> Result<(), GpuError> {
        let mut fault = None;
        // The innermost first.
        while let Some(scope) = self.0.pop() {
            fault = wait(scope.pop()).or(fault);
        }
        let adapter = adapter.to_owned();
        if let Some(why) = lost.get() {
            return Err(GpuError::Lost { adapter, why: why.clone() });
        }
        match fault {
            None => Ok(()),
            Some(wgpu::Error::OutOfMemory { .. }) => Err(GpuError::OutOfMemory { adapter }),
            Some(error) => Err(GpuError::Refused { adapter, why: one_line(&error) }),
        }
    }
}

/// What wgpu's futures need natively: they are ready, or soon will be.
pub(super) fn wait<T>(future: impl Future<Output = T>) -> T {
    let mut future = pin!(future);
    loop {
        match future.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(value) => return value,
            Poll::Pending => std::thread::yield_now(),
        }
    }
}

/// What an error says, on one line.
pub(super) fn one_line(error: &impl std::fmt::Display) -> String {
    error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
