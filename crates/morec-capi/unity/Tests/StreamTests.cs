#if UNITY_5_3_OR_NEWER
using Morec;
using NUnit.Framework;

public sealed class StreamTests
{
    [Test]
    public void WhatIsNoIndexIsRefusedWithTheLibrarysWords()
    {
        var error = Assert.Throws<MorecException>(() => new MotionIndex(new byte[] { 1, 2, 3 }));
        Assert.AreEqual(MorecStatus.BadIndex, error.Status);
        Assert.IsNotEmpty(error.Message);
    }
}
#endif
