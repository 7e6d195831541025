//! Uploads of buffers in pieces, so that copying doesn't block the queue for long, and allocations that may fail.

use super::GpuError;
use super::slices::submit_and_wait;

/// Bytes per piece: some milliseconds of copying on a software GPU.
const PIECE: usize = 4 << 20;

/// Creates a GPU resource, and checks that there was memory for it.
///
/// # Errors
/// [`GpuError::OutOfMemory`].
pub(super) fn allocated<T>(device: &wgpu::Device, make: impl FnOnce() -> T) -> Result<T, GpuError> {
    #[cfg(test)]
    shortage::check(device)?;
    let scope = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let made = make();
    match pollster::block_on(scope.pop()) {
        None => Ok(made),
        Some(_) => Err(GpuError::OutOfMemory),
    }
}

/// A buffer with these contents. Blocks: each piece is copied when the previous one is done.
///
/// # Errors
/// [`GpuError::TooLarge`], [`GpuError::OutOfMemory`].
pub(super) fn buffer(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    contents: &[u8],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, GpuError> {
    let (needed, granted) = (contents.len() as u64, device.limits().max_buffer_size);
    if needed > granted {
        return Err(GpuError::TooLarge { needed, granted });
    }
    let buffer = allocated(device, || {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: needed,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    })?;
    for (i, piece) in contents.chunks(PIECE).enumerate() {
        let write = || queue.write_buffer(&buffer, (i * PIECE) as u64, piece);
        allocated(device, write)?;
        submit_and_wait(device, queue, None);
    }
    Ok(buffer)
}

/// The number of items that fit into a buffer; at least one.
pub(super) fn items_per_buffer<T>(device: &wgpu::Device) -> usize {
    let granted = device.limits().max_buffer_size / size_of::<T>() as u64;
    granted.clamp(1, u32::MAX.into()) as usize
}

/// Buffers with these items, each within the device's size limit and with the number of its items.
///
/// # Errors
/// [`GpuError::TooLarge`] if the device's buffers can't hold even one item; [`GpuError::OutOfMemory`].
pub(super) fn buffers<T: bytemuck::NoUninit>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    items: &[T],
    usage: wgpu::BufferUsages,
) -> Result<Vec<(wgpu::Buffer, u32)>, GpuError> {
    let upload = |items: &[T]| {
        let buffer = buffer(device, queue, label, bytemuck::cast_slice(items), usage)?;
        Ok((buffer, items.len() as u32))
    };
    let parts = items.chunks(items_per_buffer::<T>(device));
    parts.map(upload).collect()
}

/// A simulated lack of memory for tests.
#[cfg(test)]
pub(crate) mod shortage {
    use super::GpuError;
    use std::sync::Mutex;

    /// Devices without free memory.
    static FULL: Mutex<Vec<wgpu::Device>> = Mutex::new(Vec::new());

    /// Makes all allocations on a device fail, or succeed again.
    pub fn set(device: &wgpu::Device, is_full: bool) {
        let mut full = FULL.lock().expect("never poisoned");
        full.retain(|other| other != device);
        if is_full {
            full.push(device.clone());
        }
    }

    pub fn check(device: &wgpu::Device) -> Result<(), GpuError> {
        let is_full = FULL.lock().expect("never poisoned").contains(device);
        if is_full {
            Err(GpuError::OutOfMemory)
        } else {
            Ok(())
        }
    }
}
