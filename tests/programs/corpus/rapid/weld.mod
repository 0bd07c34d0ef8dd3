%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%

MODULE Weld(
  NOSTEPIN
)
  LOCAL CONST robtarget p10:=[[600,100.5,500],[0.0,0.0,1.0,0.0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  LOCAL CONST robtarget p20:=[[600,100.5,500],[0.0,0.0,1.0,0.0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC Seam()
    ArcLStart p10,v100,seam1,weld1\Weave:=weave1,fine,tTorch\WObj:=wJig;
    ArcC p20,[[610,100,500],[0,0,1,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,seam1,weld1,z1,tTorch\WObj:=wJig;
    ArcLEnd p20,v100,seam1,weld1,fine,tTorch\WObj:=wJig;
  ENDPROC
ENDMODULE
