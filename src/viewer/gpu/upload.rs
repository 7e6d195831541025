//! Uploads of buffers in pieces, so that copying doesn't block the queue for long.

use super::GpuError;
use super::slices::submit_and_wait;

/// Bytes per piece: some milliseconds of copying on a software GPU.
const PIECE: usize = 4 << 20;

/// A buffer with these contents. Blocks: each piece is copied when the previous one is done.
///
/// # Errors
/// [`GpuError::TooLarge`].
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
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: needed,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    for (i, piece) in contents.chunks(PIECE).enumerate() {
        queue.write_buffer(&buffer, (i * PIECE) as u64, piece);
        submit_and_wait(device, queue, None);
    }
    Ok(buffer)
}

/// Buffers with these items, each within the device's size limit and with the number of its items.
///
/// # Errors
/// [`GpuError::TooLarge`] if the device allows no buffer for even one item.
pub(super) fn buffers<T: bytemuck::NoUninit>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    items: &[T],
    usage: wgpu::BufferUsages,
) -> Result<Vec<(wgpu::Buffer, u32)>, GpuError> {
    let granted = device.limits().max_buffer_size / size_of::<T>() as u64;
    let per_buffer = granted.clamp(1, u32::MAX.into()) as usize;
    let upload = |items: &[T]| {
        let buffer = buffer(device, queue, label, bytemuck::cast_slice(items), usage)?;
        Ok((buffer, items.len() as u32))
    };
    items.chunks(per_buffer).map(upload).collect()
}
