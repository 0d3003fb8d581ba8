using System;
using System.Runtime.InteropServices;
using System.Text;

namespace Morec
{
    /// <summary>A call to the library failed; the message is the library's.</summary>
    public sealed class MorecException : Exception
    {
        public readonly MorecStatus Status;

        internal MorecException(MorecStatus status) : base(Text.Of(Native.morec_last_error()))
        {
            Status = status;
        }

        internal static void Check(MorecStatus status)
        {
            if (status != MorecStatus.Ok) throw new MorecException(status);
        }
    }

    /// <summary>A trained index, from a file written by `morec train` or the studio. Any number of threads may use it.</summary>
    public sealed class MotionIndex : IDisposable
    {
        internal IntPtr Handle;
        readonly string[] classes;

        /// <summary>Reads the bytes of an index file. Throws MorecException if they are not an index.</summary>
        public MotionIndex(byte[] bytes)
        {
            MorecException.Check(Native.morec_index_from_memory(bytes, (UIntPtr)bytes.Length, out Handle));
            var facts = new MorecIndexFacts { struct_size = Native.SizeOf<MorecIndexFacts>() };
            MorecException.Check(Native.morec_index_facts(Handle, ref facts));
            classes = new string[facts.class_count];
            for (uint i = 0; i < classes.Length; i++) classes[i] = NameOf(i);
        }

        /// <summary>Names of the classes; the class number of an event is an index into this list.</summary>
        public string[] Classes { get { return (string[])classes.Clone(); } }

        /// <summary>Name of a class.</summary>
        public string ClassName(uint id) { return classes[id]; }

        string NameOf(uint id)
        {
            UIntPtr needed;
            Native.morec_index_class_name(Handle, id, null, UIntPtr.Zero, out needed);
            var bytes = new byte[(int)needed];
            MorecException.Check(Native.morec_index_class_name(Handle, id, bytes, needed, out needed));
            return Encoding.UTF8.GetString(bytes, 0, bytes.Length - 1);
        }

        /// <summary>Streams made from this index stay valid.</summary>
        public void Dispose()
        {
            if (Handle != IntPtr.Zero) Native.morec_index_destroy(Handle);
            Handle = IntPtr.Zero;
        }
    }

    static class Text
    {
        /// <summary>A text of the library, UTF-8, zero-terminated.</summary>
        internal static string Of(IntPtr text)
        {
            var count = 0;
            while (Marshal.ReadByte(text, count) != 0) count++;
            var bytes = new byte[count];
            Marshal.Copy(text, bytes, 0, count);
            return Encoding.UTF8.GetString(bytes);
        }
    }
}
