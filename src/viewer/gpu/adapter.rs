//! Graphics adapters: the order of backends, and the device of a program without a window.

use super::GpuError;
use hitscope_lab::commands::print_line;
use std::sync::atomic::{AtomicBool, Ordering};
use wgpu::Backends;

/// Backends in the order in which they are tried. OpenGL comes last and alone: requested together with Vulkan, it
/// makes a driver set up both, which looks for a display server, and NVIDIA's driver can deadlock when it closes
/// them.
const DEFAULT_ORDER: [Backends; 2] = [Backends::PRIMARY, Backends::GL];

/// wgpu's environment variable for the backends to try first, such as `vulkan,gl`.
const VARIABLE: &str = "WGPU_BACKEND";

/// Sets of backends, which are tried in order until one has an adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BackendOrder {
    /// The sets, best first.
    pub sets: Vec<Backends>,
    /// A warning if the environment variable has a bad value.
    pub warning: Option<String>,
}

impl BackendOrder {
    /// The order for the process's environment.
    pub fn from_env() -> Self {
        let value = std::env::var_os(VARIABLE);
        Self::new(
            value
                .as_deref()
                .map(|value| value.to_string_lossy())
                .as_deref(),
        )
    }

    /// The order for this value of the environment variable: the named backends, then the others.
    pub fn new(value: Option<&str>) -> Self {
        let mut order = Self {
            sets: DEFAULT_ORDER.to_vec(),
            warning: None,
        };
        let Some(value) = value else { return order };
        let words = value
            .split(',')
            .map(str::trim)
            .filter(|word| !word.is_empty());
        let (known, unknown): (Vec<&str>, Vec<&str>) =
            words.partition(|word| !Backends::from_comma_list(word).is_empty());
        let named = known
            .iter()
            .map(|word| Backends::from_comma_list(word))
            .fold(Backends::empty(), Backends::union);
        if !named.is_empty() {
            let others = order.sets.iter().map(|&set| set.difference(named));
            let others = others.filter(|set| !set.is_empty());
            order.sets = std::iter::once(named).chain(others).collect();
        }
        let is_bad = named.is_empty() || !unknown.is_empty();
        order.warning = is_bad.then(|| {
            let what = match unknown.as_slice() {
                [] => "it names no graphics backend".to_owned(),
                [word] => format!("“{}” isn't a graphics backend", word.escape_debug()),
                [word, ..] => format!(
                    "“{}” and others aren't graphics backends",
                    word.escape_debug()
                ),
            };
            format!("{VARIABLE} is partly or wholly ignored: {what} (expected vulkan, metal, dx12 or gl)")
        });
        order
    }

    /// Calls `open` with each set until it succeeds. A set without an adapter gives an error for which `is_graphics`
    /// holds; any other error ends the search.
    ///
    /// # Errors
    /// The last error of `open`.
    pub fn first_that_opens<T, E: std::fmt::Display>(
        &self,
        is_graphics: impl Fn(&E) -> bool,
        mut open: impl FnMut(Backends) -> Result<T, E>,
    ) -> Result<T, E> {
        if let Some(warning) = &self.warning {
            print_line(format_args!("hitscope: {warning}"));
        }
        // An order always has at least one set.
        let (&last, others) = self.sets.split_last().unwrap_or((&Backends::GL, &[]));
        for &backends in others {
            match open(backends) {
                Err(error) if is_graphics(&error) => {
                    if self.is_named(backends) {
                        print_line(format_args!(
                            "hitscope: {VARIABLE} can't be used ({error}); trying others"
                        ));
                    }
                }
                result => return result,
            }
        }
        open(last)
    }

    /// Whether the environment variable names these.
    fn is_named(&self, backends: Backends) -> bool {
        self.sets.first() == Some(&backends) && self.sets != DEFAULT_ORDER
    }
}

/// A graphics device without a window.
///
/// A process has one at a time: NVIDIA's driver can deadlock if several are created and dropped concurrently.
pub struct Gpu {
    /// The connection to the drivers.
    pub instance: wgpu::Instance,
    /// The GPU or software renderer.
    pub adapter: wgpu::Adapter,
    /// Creates buffers, textures and pipelines.
    pub device: wgpu::Device,
    /// Executes commands.
    pub queue: wgpu::Queue,
}

/// Whether this process has a [`Gpu`].
static IS_OPEN: AtomicBool = AtomicBool::new(false);

impl Gpu {
    /// Opens the first adapter that a backend has, with its largest buffer limits.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`].
    ///
    /// # Panics
    /// In debug builds, if the process already has one.
    pub fn open() -> Result<Self, GpuError> {
        let was_open = IS_OPEN.swap(true, Ordering::Relaxed);
        debug_assert!(!was_open, "a process has one wgpu::Instance at a time");
        let is_graphics = |_: &String| true;
        let opened = BackendOrder::from_env()
            .first_that_opens(is_graphics, |backends| pollster::block_on(open(backends)))
            .map_err(GpuError::NoAdapter);
        if opened.is_err() {
            IS_OPEN.store(false, Ordering::Relaxed);
        }
        opened
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        IS_OPEN.store(false, Ordering::Relaxed);
    }
}

#[expect(
    clippy::disallowed_methods,
    reason = "the one place that makes an instance, guarded by IS_OPEN"
)]
async fn open(backends: Backends) -> Result<Gpu, String> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        ..wgpu::InstanceDescriptor::new_without_display_handle_from_env()
    });
    let adapter = instance
        .request_adapter(&wgpu::RequestAdapterOptions::default())
        .await
        .map_err(|error| error.to_string())?;
    let (device, queue) = adapter
        .request_device(&device_descriptor(&adapter))
        .await
        .map_err(|error| error.to_string())?;
    Ok(Gpu {
        instance,
        adapter,
        device,
        queue,
    })
}

/// A device with the adapter's largest limits on buffers and textures, which a mesh or a picture may need.
///
/// Its memory is allocated in small blocks. wgpu doubles the size of each further block, up to 256 MB by default, and
/// keeps empty ones: 600 random actions left two of 128 MB (2026-11). What doesn't fit has a block of its own.
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    /// Bytes.
    const BLOCK: u64 = 8 << 20;
    let granted = adapter.limits();
    // The base that egui requests.
    let base = if adapter.get_info().backend == wgpu::Backend::Gl {
        wgpu::Limits::downlevel_webgl2_defaults()
    } else {
        wgpu::Limits::default()
    };
    wgpu::DeviceDescriptor {
        label: Some("hitscope"),
        required_limits: wgpu::Limits {
            max_buffer_size: granted.max_buffer_size,
            max_texture_dimension_2d: granted.max_texture_dimension_2d,
            ..base
        },
        memory_hints: wgpu::MemoryHints::Manual {
            suballocated_device_memory_block_size: BLOCK..BLOCK,
        },
        ..wgpu::DeviceDescriptor::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opengl_is_tried_alone_and_last() {
        let order = BackendOrder::new(None);
        assert_eq!(order.sets, [Backends::PRIMARY, Backends::GL]);
        assert_eq!(order.warning, None);
    }

    #[test]
    fn named_backends_come_first_and_the_others_follow() {
        let order = BackendOrder::new(Some("GL"));
        assert_eq!(order.sets, [Backends::GL, Backends::PRIMARY]);
        assert_eq!(order.warning, None);
        let order = BackendOrder::new(Some("vk, dx12"));
        let named = Backends::VULKAN | Backends::DX12;
        assert_eq!(order.sets, [named, Backends::PRIMARY - named, Backends::GL]);
        assert_eq!(order.warning, None);
    }

    #[test]
    fn sets_are_tried_in_order_and_the_last_error_is_returned() {
        let order = BackendOrder::new(Some("vulkan"));
        let mut tried = Vec::new();
        let opened = order.first_that_opens(
            |_: &&str| true,
            |backends| {
                tried.push(backends);
                if backends == Backends::GL {
                    Ok(7)
                } else {
                    Err("none")
                }
            },
        );
        assert_eq!((opened, tried.as_slice()), (Ok(7), order.sets.as_slice()));
        let failed = order.first_that_opens(|_| true, |backends| Err::<(), _>(backends.bits()));
        assert_eq!(failed, Err(Backends::GL.bits()));
        // Other backends don't help with an error that isn't about graphics.
        let failed = order.first_that_opens(|_| false, |backends| Err::<(), _>(backends.bits()));
        assert_eq!(failed, Err(Backends::VULKAN.bits()));
    }

    #[test]
    fn a_value_without_a_valid_name_keeps_the_default_order_and_gives_a_warning() {
        for value in ["", " ,", "glide", "glide,3dfx"] {
            let order = BackendOrder::new(Some(value));
            assert_eq!(order.sets, DEFAULT_ORDER, "{value:?}");
            let warning = order.warning.expect(value);
            assert!(warning.starts_with("WGPU_BACKEND "), "{warning}");
            assert_eq!(
                warning.contains("“glide”"),
                value.contains("glide"),
                "{warning}"
            );
        }
        let order = BackendOrder::new(Some("glide,gl"));
        assert_eq!(order.sets, [Backends::GL, Backends::PRIMARY]);
        assert!(
            order
                .warning
                .is_some_and(|warning| warning.contains("“glide”"))
        );
    }
}
